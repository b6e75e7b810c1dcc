import { Slider } from "../../controls/Slider";
import type { PathProps } from "./paths";
import { WalkRefusal } from "./WalkRefusal";

/** Twist and duration. */
export function TwistInputs({ path, set }: PathProps<"twist">) {
  const [vx, vy] = path.velocity_mm_s;
  return (
    <>
      <Slider
        label="Forward speed"
        value={vx}
        min={-200}
        max={200}
        typedMin={-2000}
        typedMax={2000}
        step={5}
        unit="mm/s"
        testId="twist-x"
        note={<WalkRefusal at="path.velocity_mm_s[0]" />}
        onChange={(next, commit) => set({ ...path, velocity_mm_s: [next, vy] }, commit)}
      />
      <Slider
        label="Left speed"
        value={vy}
        min={-200}
        max={200}
        typedMin={-2000}
        typedMax={2000}
        step={5}
        unit="mm/s"
        testId="twist-y"
        note={<WalkRefusal at="path.velocity_mm_s[1]" />}
        onChange={(next, commit) => set({ ...path, velocity_mm_s: [vx, next] }, commit)}
      />
      <Slider
        label="Left turn rate"
        value={path.turn_deg_s}
        min={-60}
        max={60}
        typedMin={-720}
        typedMax={720}
        step={1}
        unit="°/s"
        testId="twist-turn"
        note={<WalkRefusal at="path.turn_deg_s" />}
        onChange={(turn_deg_s, commit) => set({ ...path, turn_deg_s }, commit)}
      />
      <Slider
        label="Duration"
        value={path.duration_s}
        min={1}
        max={30}
        typedMin={0.1}
        typedMax={300}
        step={0.5}
        unit="s"
        testId="twist-duration"
        note={<WalkRefusal at="path.duration_s" />}
        onChange={(duration_s, commit) => set({ ...path, duration_s }, commit)}
      />
    </>
  );
}
