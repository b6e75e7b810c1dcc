import { Facts } from "../../controls/Facts";
import { Message, Remarks } from "../../controls/Message";
import { withUnit } from "../../controls/numbers";
import type { WalkMessage } from "../../protocol";

interface Props {
  walk: WalkMessage;
  /** Whether the present inputs are refused: then this is an earlier walk. */
  refused: boolean;
}

/** Summary of the planned walk. */
export function WalkSummary({ walk, refused }: Props) {
  const { end, least_margin: margin } = walk;
  return (
    <>
      {refused ? (
        <Message kind="warn" testId="walk-verdict">
          These inputs are refused. The last accepted walk is shown.
        </Message>
      ) : (
        <Message kind={walk.possible ? "good" : "bad"} testId="walk-verdict">
          {walk.possible ? "Every foot reaches its whole path." : "This walk is not possible."}
        </Message>
      )}
      <Remarks kind="warn" items={walk.problems} testId="walk-problems" />
      <Facts
        testId="walk-facts"
        rows={[
          ["Duration", withUnit(walk.duration_s, 2, "s")],
          ["Steps", walk.steps],
          ["Stroke", withUnit(walk.stroke_mm, 1, "mm")],
          ["Longest stroke", withUnit(walk.longest_stroke_mm, 1, "mm")],
          ["Speed", withUnit(walk.speed_mm_s, 1, "mm/s")],
          ["End position x, y", `${end.x_mm.toFixed(1)}, ${end.y_mm.toFixed(1)} mm`],
          ["End heading", withUnit(end.turned_deg, 1, "°")],
          ["Minimum stability margin", `${withUnit(margin.mm, 1, "mm")} at ${withUnit(margin.at_s, 2, "s")}`],
          [
            "Minimum distance between feet",
            `${withUnit(walk.nearest_feet.mm, 0, "mm")} (${walk.nearest_legs.join(", ")})`,
          ],
          ...walk.joint_speed.map(
            (speed) =>
              [
                `Max. speed of ${speed.joint}`,
                `${withUnit(speed.deg_s, 0, "°/s")}${speed.no_load_fraction === null ? "" : ` (${Math.round(speed.no_load_fraction * 100)} % of no-load)`}`,
              ] as const,
          ),
        ]}
      />
      {walk.assumed.length > 0 && (
        <details>
          <summary>Assumptions of the plan</summary>
          <div className="inside">
            <ul>
              {walk.assumed.map((line) => (
                <li key={line}>{line}</li>
              ))}
            </ul>
          </div>
        </details>
      )}
    </>
  );
}
