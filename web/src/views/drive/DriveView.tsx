import { ViewHead } from "../ViewHead";

/** To come. */
export function DriveView() {
  return (
    <div className="view">
      <ViewHead title="Drive">To come.</ViewHead>
    </div>
  );
}
