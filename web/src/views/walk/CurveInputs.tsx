import { Slider } from "../../controls/Slider";
import { useTouch } from "../../controls/useTouch";
import type { PathProps } from "./paths";
import { WalkRefusal } from "./WalkRefusal";

/** Angle and centre of a curve. */
export function CurveInputs({ path, set }: PathProps<"curve">) {
  const [x, y] = path.centre_mm;
  const touch = useTouch();
  return (
    <>
      <Slider
        label="Angle (positive: left)"
        value={path.angle_deg}
        min={-360}
        max={360}
        typedMin={-3600}
        typedMax={3600}
        step={5}
        unit="°"
        testId="curve-angle"
        note={<WalkRefusal at="path.angle_deg" />}
        onChange={(angle_deg, commit) => set({ ...path, angle_deg }, commit)}
      />
      <p className="hint">{touch ? "Tap" : "Click on"} the ground to set the centre, or enter it here.</p>
      <Slider
        label="Centre x (forward)"
        value={x}
        min={-1000}
        max={1000}
        typedMin={-20_000}
        typedMax={20_000}
        step={10}
        unit="mm"
        testId="centre-x"
        note={<WalkRefusal at="path.centre_mm[0]" />}
        onChange={(next, commit) => set({ ...path, centre_mm: [next, y] }, commit)}
      />
      <Slider
        label="Centre y (left)"
        value={y}
        min={-1000}
        max={1000}
        typedMin={-20_000}
        typedMax={20_000}
        step={10}
        unit="mm"
        testId="centre-y"
        note={<WalkRefusal at="path.centre_mm[1]" />}
        onChange={(next, commit) => set({ ...path, centre_mm: [x, next] }, commit)}
      />
    </>
  );
}
