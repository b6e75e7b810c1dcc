import { Failure, Refusal } from "../controls/Failure";
import { Icon } from "../controls/icons";
import { Slider } from "../controls/Slider";
import type { PoseMessage, RobotMessage } from "../protocol";
import { legColours } from "../scene/palette";
import { triple } from "../scene/kinematics";
import { ask, change } from "../state/session";
import { useStudio } from "../state/store";
import { AngleTable } from "./AngleTable";
import { CalibrationFile } from "./CalibrationFile";
import { Standing } from "./Standing";
import { useInputs } from "./useInputs";
import { ViewHead } from "./ViewHead";
import { WorkspaceChoice } from "./WorkspaceChoice";
import { JOINTS } from "./angleText";

/** Forward kinematics: from the joint angles to the resting pose of the robot. */
export function JointsView() {
  const { robot, state } = useInputs();
  const pose = useStudio((studio) => studio.poses.joints);
  const angles =
    state.joints.angles_deg ?? robot.stance_angles_deg ?? robot.leg_names.flatMap(() => [0, 0, 0]);
  const colours = legColours(robot.leg_names.map((_, leg) => triple(robot.mount_mm, leg)));

  const set = (index: number, value: number, commit: boolean) => {
    const next = [...angles];
    next[index] = value;
    change("joints", { angles_deg: next }, commit);
  };
  return (
    <div className="view">
      <ViewHead title="Joints">
        Set any joint angle; the resting pose on the ground is computed. Feet can be dragged in the 3D view.
      </ViewHead>
      <Failure of={["joints", "drag_foot", "calibration"]} />
      {pose && <Standing pose={pose} />}
      <div className="row">
        <button
          type="button"
          className="button"
          data-testid="rest-stance"
          onClick={() => change("joints", { angles_deg: null })}
        >
          <Icon name="reset" /> Default stance
        </button>
        <button
          type="button"
          className="button"
          data-testid="download-angles"
          onClick={() => ask({ type: "download", what: "angles" })}
        >
          <Icon name="save" /> Export angles
        </button>
      </div>
      {robot.leg_names.map((name, leg) => (
        <fieldset key={name}>
          <legend>
            <span className="dot" style={{ background: colours[leg] }} />
            {robot.leg_codes[leg]} – {name}
            <Contact pose={pose} leg={leg} />
          </legend>
          {JOINTS.map((joint, i) => (
            <Joint
              key={joint}
              robot={robot}
              pose={pose}
              leg={leg}
              joint={i}
              value={angles[leg * 3 + i] ?? 0}
              onChange={(value, commit) => set(leg * 3 + i, value, commit)}
            />
          ))}
        </fieldset>
      ))}
      <WorkspaceChoice />
      <CalibrationFile />
      <AngleTable codes={robot.leg_codes} angles={angles} />
    </div>
  );
}

function Contact({ pose, leg }: { pose: PoseMessage | undefined; leg: number }) {
  if (!pose) return null;
  const down = pose.contacts[leg] === "1";
  return (
    <>
      {" "}
      <span className={`badge${down ? " good" : ""}`}>{down ? "on the ground" : "in the air"}</span>
    </>
  );
}

interface JointProps {
  robot: RobotMessage;
  pose: PoseMessage | undefined;
  leg: number;
  joint: number;
  value: number;
  onChange: (value: number, commit: boolean) => void;
}

function Joint({ robot, pose, leg, joint, value, onChange }: JointProps) {
  const name = JOINTS[joint] ?? "coxa";
  const at = (leg * 3 + joint) * 2;
  const broken = pose?.limits.some((limit) => limit.leg === leg && limit.joint === name) ?? false;
  return (
    <Slider
      compact
      label={name}
      name={`${robot.leg_names[leg] ?? ""} ${name}`}
      value={value}
      min={robot.limits_deg[at] ?? -180}
      max={robot.limits_deg[at + 1] ?? 180}
      typedMin={-180}
      typedMax={180}
      step={0.5}
      unit="°"
      bad={broken}
      testId={`joint-${robot.leg_codes[leg] ?? leg}-${name}`}
      note={<Refusal of="joints" at={`angles_deg[${leg * 3 + joint}]`} />}
      onChange={onChange}
    />
  );
}
