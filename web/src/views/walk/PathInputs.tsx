import { Segments } from "../../controls/Segments";
import { change } from "../../state/session";
import { useInputs } from "../useInputs";
import { CurveInputs } from "./CurveInputs";
import { pathOf, type Path } from "./paths";
import { StraightInputs } from "./StraightInputs";
import { TwistInputs } from "./TwistInputs";
import { WalkRefusal } from "./WalkRefusal";

/** Path of the body: straight, around a centre, or with a constant twist. */
export function PathInputs() {
  const { state } = useInputs();
  const { path } = state.walk;
  const set = (next: Path, commit = true) => change("walk", { path: next }, commit);
  return (
    <fieldset>
      <legend>Path</legend>
      <div className="row">
        <Segments
          label="Kind of path"
          testId="path-kind"
          value={path.kind}
          options={[
            { value: "straight", label: "Straight" },
            { value: "curve", label: "Curve" },
            { value: "twist", label: "Constant twist" },
          ]}
          onChange={(kind) => set(pathOf(kind))}
        />
      </div>
      <WalkRefusal at="path.kind" />
      {path.kind === "straight" && <StraightInputs path={path} set={set} />}
      {path.kind === "curve" && <CurveInputs path={path} set={set} />}
      {path.kind === "twist" && <TwistInputs path={path} set={set} />}
    </fieldset>
  );
}
