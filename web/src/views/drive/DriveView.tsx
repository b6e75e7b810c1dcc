import { useState } from "react";

import { Failure } from "../../controls/Failure";
import { Select } from "../../controls/Select";
import { Slider } from "../../controls/Slider";
import { useTouch } from "../../controls/useTouch";
import { useStudio } from "../../state/store";
import { AngleTable } from "../AngleTable";
import { PhysicsFields } from "../physics/PhysicsFields";
import { useInputs } from "../useInputs";
import { ViewHead } from "../ViewHead";
import { BodyPose } from "./BodyPose";
import { DriveFacts, DriveRemarks } from "./DriveFacts";
import { RunPart } from "./RunPart";
import { stateText } from "./robotState";
import { StateButtons } from "./StateButtons";
import { Stick } from "./Stick";
import { useDriving, type BodyPoseValues, type Settings } from "./useDriving";

const LEVEL: BodyPoseValues = [0, 0, 0, 0, 0, 0];

const DEFAULTS: Settings = {
  speed: 120,
  turn: 25,
  gait: null,
  bodyHeight: null,
  swingHeight: null,
  body: LEVEL,
  state: "standing",
};

/** A machine stays as it is until something else is asked for. */
const AS_IT_IS: Settings = { ...DEFAULTS, speed: 60, turn: 20, body: null, state: null };

/** Drive the robot live; another robot starts with the default settings. */
export function DriveView() {
  const { robot } = useInputs();
  return <DriveControls key={robot.name} />;
}

function DriveControls() {
  const { robot } = useInputs();
  const drive = useStudio((studio) => studio.drive);
  const run = useStudio((studio) => studio.welcome?.run ?? null);
  const [settings, setSettings] = useState<Settings>(run ? AS_IT_IS : DEFAULTS);
  const [attempt, setAttempt] = useState(0);
  const sticks = useDriving(settings, attempt);
  const touch = useTouch();
  const set = (values: Partial<Settings>) => setSettings((before) => ({ ...before, ...values }));
  return (
    <div className="view">
      <ViewHead title="Drive">
        {touch
          ? "Push the sticks to walk and turn. The robot stops when they are released."
          : "Keys W, A, S, D walk, Q and E turn; the arrow keys walk and turn. So do the sticks and a gamepad. The robot stops when they are released."}
      </ViewHead>
      <Failure of={["drive", "command", "end_run"]}>
        {run && !drive && (
          <button
            type="button"
            className="button small"
            data-testid="drive-again"
            onClick={() => setAttempt(attempt + 1)}
          >
            Try again
          </button>
        )}
      </Failure>
      {run && <RunPart bus={run.bus} frame={drive} />}
      <StateButtons
        requested={settings.state}
        present={drive?.state ?? "standing"}
        onRequest={(state) => set({ state })}
      />
      <p className="state" role="status">
        State: <strong data-testid="drive-state">{drive ? stateText(drive) : "–"}</strong>
      </p>
      <div className="sticks">
        <figure>
          <Stick label="Walk" testId="stick-walk" onDeflect={sticks.walk} />
          <figcaption>Walk</figcaption>
        </figure>
        <figure>
          <Stick label="Turn" flat testId="stick-turn" onDeflect={(x) => sticks.turn(x)} />
          <figcaption>Turn</figcaption>
        </figure>
      </div>
      {drive && <DriveRemarks frame={drive} onRestart={() => setAttempt(attempt + 1)} />}
      {!run && <PhysicsFields driven />}
      <fieldset>
        <Slider
          label="Top speed"
          value={settings.speed}
          min={10}
          max={300}
          step={5}
          unit="mm/s"
          testId="drive-speed"
          onChange={(speed) => set({ speed })}
        />
        <Slider
          label="Top turn rate"
          value={settings.turn}
          min={5}
          max={60}
          step={1}
          unit="°/s"
          testId="drive-turn"
          onChange={(turn) => set({ turn })}
        />
        <Select
          label="Gait"
          testId="drive-gait"
          value={settings.gait ?? ""}
          options={[
            { value: "", label: `robot default (${robot.gait})` },
            ...robot.gaits.map((name) => ({ value: name, label: name })),
          ]}
          onChange={(gait) => set({ gait: gait || robot.gait })}
        />
        <Slider
          label="Body height"
          value={settings.bodyHeight ?? robot.body_height_mm}
          min={Math.round(robot.body_height_mm * 0.5)}
          max={Math.round(robot.body_height_mm * 1.6)}
          step={1}
          unit="mm"
          testId="drive-body-height"
          onChange={(bodyHeight) => set({ bodyHeight })}
        />
        <Slider
          label="Swing height"
          value={settings.swingHeight ?? robot.swing_height_mm}
          min={5}
          max={80}
          step={1}
          unit="mm"
          testId="drive-swing-height"
          onChange={(swingHeight) => set({ swingHeight })}
        />
        <BodyPose body={settings.body ?? LEVEL} onChange={(body) => set({ body })} />
      </fieldset>
      {drive && (
        <>
          <DriveFacts frame={drive} />
          <AngleTable
            codes={robot.leg_codes}
            angles={drive.angles_deg}
            measured={drive.machine?.angles_deg}
          />
        </>
      )}
    </div>
  );
}
