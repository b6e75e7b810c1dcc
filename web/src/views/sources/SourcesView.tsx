import { ViewHead } from "../ViewHead";

/** To come. */
export function SourcesView() {
  return (
    <div className="view">
      <ViewHead title="Sources">To come.</ViewHead>
    </div>
  );
}
