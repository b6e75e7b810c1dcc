import { Slider } from "../../controls/Slider";
import type { PathProps } from "./paths";
import { WalkRefusal } from "./WalkRefusal";

/** Distance and direction of a straight walk. */
export function StraightInputs({ path, set }: PathProps<"straight">) {
  return (
    <>
      <Slider
        label="Distance"
        value={path.distance_mm}
        min={50}
        max={2000}
        typedMin={0}
        typedMax={20_000}
        step={10}
        unit="mm"
        testId="distance"
        note={<WalkRefusal at="path.distance_mm" />}
        onChange={(distance_mm, commit) => set({ ...path, distance_mm }, commit)}
      />
      <Slider
        label="Direction (90° is left)"
        value={path.heading_deg}
        min={-180}
        max={180}
        step={5}
        unit="°"
        testId="heading"
        note={<WalkRefusal at="path.heading_deg" />}
        onChange={(heading_deg, commit) => set({ ...path, heading_deg }, commit)}
      />
    </>
  );
}
