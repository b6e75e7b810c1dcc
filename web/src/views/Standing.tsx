import { Check } from "../controls/Check";
import { Message, Remarks } from "../controls/Message";
import { Facts } from "../controls/Facts";
import { withUnit } from "../controls/numbers";
import type { PoseMessage } from "../protocol";
import { contactsOf } from "../scene/frames";
import { useOptions } from "../state/options";
import { useStudio } from "../state/store";

/** The standing or resting robot: result in words, problems, and values. */
export function Standing({ pose }: { pose: PoseMessage }) {
  // A leg out of reach may be reported twice: for the leg, and for the robot.
  const problems = [
    ...new Set([
      ...pose.legs.map((leg) => leg.text),
      ...pose.limits.map((limit) => limit.text),
      ...pose.problems,
    ]),
  ];
  const forces = useOptions((options) => options.forces);
  const hasMasses = useStudio((studio) => studio.robot?.mass_kg != null);
  const feet = contactsOf(pose.contacts).filter(Boolean).length;
  const [x = 0, y = 0, z = 0] = pose.position_mm;
  const [roll = 0, pitch = 0] = pose.rpy_deg;
  return (
    <>
      <div aria-live="polite" className="field">
        <Message kind={pose.stable ? "good" : "bad"} testId="standing">
          <span className="lines">{pose.text}</span>
        </Message>
        <Remarks kind="bad" items={problems} testId="problems" />
      </div>
      {hasMasses && (
        <Check
          label="Show forces and torques"
          testId="show-forces"
          checked={forces}
          onChange={(checked) => useOptions.setState({ forces: checked })}
        />
      )}
      <Facts
        testId="standing-facts"
        rows={[
          ["Stability margin", withUnit(pose.margin_mm, 1, "mm")],
          ["Feet on the ground", feet],
          ["Body position x, y, z", `${x.toFixed(1)}, ${y.toFixed(1)}, ${z.toFixed(1)} mm`],
          ["Roll, pitch", `${roll.toFixed(1)}, ${pitch.toFixed(1)}°`],
        ]}
      />
    </>
  );
}
