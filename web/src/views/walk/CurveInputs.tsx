import { Slider } from "../../controls/Slider";
import type { PathProps } from "./paths";

/** Angle and centre of a curve. */
export function CurveInputs({ path, set }: PathProps<"curve">) {
  const [x, y] = path.centre_mm;
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
        onChange={(angle_deg, commit) => set({ ...path, angle_deg }, commit)}
      />
      <p className="hint">Click on the ground to set the centre, or enter it here.</p>
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
        onChange={(next, commit) => set({ ...path, centre_mm: [x, next] }, commit)}
      />
    </>
  );
}
