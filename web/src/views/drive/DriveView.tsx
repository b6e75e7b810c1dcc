import { useState } from "react";

import { Facts } from "../../controls/Facts";
import { Failure } from "../../controls/Failure";
import { Remarks } from "../../controls/Message";
import { withUnit } from "../../controls/numbers";
import { Select } from "../../controls/Select";
import { Slider } from "../../controls/Slider";
import { useStudio } from "../../state/store";
import { AngleTable } from "../AngleTable";
import { useInputs } from "../useInputs";
import { ViewHead } from "../ViewHead";
import { BodyPose } from "./BodyPose";
import { Stick } from "./Stick";
import { useDriving, type Settings } from "./useDriving";

const BEGIN: Settings = {
  speed: 120,
  turn: 25,
  gait: null,
  bodyHeight: null,
  swingHeight: null,
  body: [0, 0, 0, 0, 0, 0],
};

/** Drive the robot live. */
export function DriveView() {
  const { robot } = useInputs();
  const drive = useStudio((studio) => studio.drive);
  const [settings, setSettings] = useState<Settings>(BEGIN);
  const sticks = useDriving(settings);
  const set = (values: Partial<Settings>) => setSettings((before) => ({ ...before, ...values }));
  return (
    <div className="view">
      <ViewHead title="Drive">
        Keys W, A, S, D walk and Q, E turn; or push the sticks, or a gamepad’s. Let go, and it stops on its
        feet.
      </ViewHead>
      <Failure of={["drive", "command"]} />
      <div className="sticks">
        <figure>
          <Stick label="Walk" testId="stick-walk" onPush={sticks.walk} />
          <figcaption>Walk</figcaption>
        </figure>
        <figure>
          <Stick label="Turn" flat testId="stick-turn" onPush={(x) => sticks.turn(x)} />
          <figcaption>Turn</figcaption>
        </figure>
      </div>
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
          label="Top turn"
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
            { value: "", label: `the robot’s own (${robot.gait})` },
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
          testId="drive-bodyHeight"
          onChange={(bodyHeight) => set({ bodyHeight })}
        />
        <Slider
          label="Swing height"
          value={settings.swingHeight ?? robot.swing_height_mm}
          min={5}
          max={80}
          step={1}
          unit="mm"
          testId="drive-swingHeight"
          onChange={(swingHeight) => set({ swingHeight })}
        />
        <BodyPose body={settings.body} onChange={(body) => set({ body })} />
      </fieldset>
      {drive && (
        <>
          <div aria-live="polite">
            <Remarks kind="warn" items={drive.limited} testId="drive-limited" />
          </div>
          <Facts
            testId="drive-facts"
            rows={[
              ["It is", drive.mode],
              ["Gait", drive.gait],
              ["Forward", withUnit(drive.twist[0], 0, "mm/s")],
              ["Left", withUnit(drive.twist[1], 0, "mm/s")],
              ["Turning left", withUnit(drive.twist[2], 1, "°/s")],
              [
                "At x, y",
                `${withUnit(drive.position_mm[0], 0, "")}, ${withUnit(drive.position_mm[1], 0, "mm")}`,
              ],
              ["Margin of stability", withUnit(drive.margin_mm, 0, "mm")],
              ["The guard stepped in", drive.interventions],
            ]}
          />
          <AngleTable codes={robot.leg_codes} angles={drive.angles_deg} />
        </>
      )}
    </div>
  );
}
