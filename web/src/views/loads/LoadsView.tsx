import { ViewHead } from "../ViewHead";

/** To come. */
export function LoadsView() {
  return (
    <div className="view">
      <ViewHead title="Loads">To come.</ViewHead>
    </div>
  );
}
