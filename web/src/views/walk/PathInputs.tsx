import { Segments } from "../../controls/Segments";
import { Slider } from "../../controls/Slider";
import { change } from "../../state/session";
import { useInputs } from "../useInputs";
import { pathOf, type Path } from "./paths";

/** Where the body goes: straight, round a centre, or at a constant twist. */
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
          testId="way"
          value={path.way}
          options={[
            { value: "straight", label: "Straight" },
            { value: "curve", label: "Round a centre" },
            { value: "twist", label: "Steady twist" },
          ]}
          onChange={(way) => set(pathOf(way))}
        />
      </div>
      {path.way === "straight" && <Straight path={path} set={set} />}
      {path.way === "curve" && <Curve path={path} set={set} />}
      {path.way === "twist" && <Twist path={path} set={set} />}
    </fieldset>
  );
}

interface Props<W extends Path["way"]> {
  path: Extract<Path, { way: W }>;
  set: (path: Path, commit?: boolean) => void;
}

function Straight({ path, set }: Props<"straight">) {
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
        onChange={(distance_mm, commit) => set({ ...path, distance_mm }, commit)}
      />
      <Slider
        label="Direction (90 is left)"
        value={path.heading_deg}
        min={-180}
        max={180}
        step={5}
        unit="°"
        testId="heading"
        onChange={(heading_deg, commit) => set({ ...path, heading_deg }, commit)}
      />
    </>
  );
}

function Curve({ path, set }: Props<"curve">) {
  const [x, y] = path.centre_mm;
  return (
    <>
      <Slider
        label="Turn by (negative: clockwise)"
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
      <p className="hint">The centre: click on the floor, or set it here.</p>
      <Slider
        label="Centre forward"
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
        label="Centre to the left"
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

function Twist({ path, set }: Props<"twist">) {
  const [vx, vy] = path.velocity_mm_s;
  return (
    <>
      <Slider
        label="Forward"
        value={vx}
        min={-200}
        max={200}
        typedMin={-2000}
        typedMax={2000}
        step={5}
        unit="mm/s"
        testId="twist-x"
        onChange={(next, commit) => set({ ...path, velocity_mm_s: [next, vy] }, commit)}
      />
      <Slider
        label="Left"
        value={vy}
        min={-200}
        max={200}
        typedMin={-2000}
        typedMax={2000}
        step={5}
        unit="mm/s"
        testId="twist-y"
        onChange={(next, commit) => set({ ...path, velocity_mm_s: [vx, next] }, commit)}
      />
      <Slider
        label="Turning left"
        value={path.turn_deg_s}
        min={-60}
        max={60}
        typedMin={-720}
        typedMax={720}
        step={1}
        unit="°/s"
        testId="twist-turn"
        onChange={(turn_deg_s, commit) => set({ ...path, turn_deg_s }, commit)}
      />
      <Slider
        label="For"
        value={path.duration_s}
        min={1}
        max={30}
        typedMin={0.1}
        typedMax={300}
        step={0.5}
        unit="s"
        testId="twist-duration"
        onChange={(duration_s, commit) => set({ ...path, duration_s }, commit)}
      />
    </>
  );
}
