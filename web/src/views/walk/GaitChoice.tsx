import { Select } from "../../controls/Select";
import { withUnit } from "../../controls/numbers";
import { Slider } from "../../controls/Slider";
import { change } from "../../state/session";
import { useStudio } from "../../state/store";
import { useInputs } from "../useInputs";
import { WalkRefusal } from "./WalkRefusal";

/** The gait: the default of the robot, a named one, or a custom one. */
export function GaitChoice() {
  const { robot, state } = useInputs();
  const walk = useStudio((studio) => studio.walk);
  const { gait } = state.walk;
  const own = gait !== null && typeof gait !== "string" ? gait : null;
  const choose = (value: string) => {
    if (value !== "own") change("walk", { gait: value === "" ? null : value });
    // That of the present walk, to begin with.
    else if (walk) change("walk", { gait: { duty_factor: walk.duty_factor, offsets: walk.offsets } });
  };
  return (
    <fieldset>
      <Select
        label="Gait"
        testId="gait"
        value={own ? "own" : typeof gait === "string" ? gait : ""}
        options={[
          { value: "", label: `robot default (${robot.gait})` },
          ...robot.gaits.map((name) => ({ value: name, label: name })),
          ...(walk || own ? [{ value: "own", label: "custom …" }] : []),
        ]}
        onChange={choose}
      />
      <WalkRefusal at="gait" />
      {own && (
        <>
          <Slider
            label="Duty factor"
            value={own.duty_factor}
            min={0.5}
            max={0.95}
            typedMin={0.01}
            typedMax={0.99}
            step={0.01}
            unit=""
            testId="duty-factor"
            note={<WalkRefusal at="gait.duty_factor" />}
            onChange={(value, commit) => change("walk", { gait: { ...own, duty_factor: value } }, commit)}
          />
          <p className="label">Touch-down of each foot, as a fraction of the cycle</p>
          {robot.leg_codes.map((code, leg) => (
            <Slider
              key={code}
              compact
              label={code}
              name={`${robot.leg_names[leg] ?? ""}: touch-down phase`}
              value={own.offsets[leg] ?? 0}
              min={0}
              max={1}
              step={0.01}
              unit=""
              testId={`phase-${code}`}
              note={<WalkRefusal at={`gait.offsets[${leg}]`} />}
              onChange={(offset, commit) =>
                change(
                  "walk",
                  { gait: { ...own, offsets: own.offsets.map((old, i) => (i === leg ? offset : old)) } },
                  commit,
                )
              }
            />
          ))}
        </>
      )}
      {walk && (
        <p className="hint" data-testid="gait-text">
          {walk.gait}: each foot is in stance for {withUnit(walk.duty_factor * 100, 0, "%")} of the cycle of{" "}
          {withUnit(walk.cycle_time_s, 2, "s")}.
        </p>
      )}
    </fieldset>
  );
}
