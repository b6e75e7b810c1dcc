import { ViewHead } from "../ViewHead";

/** To come. */
export function RobotView() {
  return (
    <div className="view">
      <ViewHead title="Robot">To come.</ViewHead>
    </div>
  );
}
