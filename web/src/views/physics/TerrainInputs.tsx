import { Select } from "../../controls/Select";
import { Slider } from "../../controls/Slider";
import type { TerrainChoice } from "../../protocol";
import { change } from "../../state/session";
import { useStudio } from "../../state/store";
import { useInputs } from "../useInputs";

/** Choice of the terrain and its parameters. */
export function TerrainInputs() {
  const { terrain } = useInputs().state.physics;
  const kinds = useStudio((studio) => studio.welcome?.physics.terrains ?? []);
  const parameters = kinds.find(({ kind }) => kind === terrain.kind)?.parameters ?? [];
  const set = (values: Partial<TerrainChoice>, commit = true) =>
    change("physics", { terrain: { ...terrain, ...values } }, commit);
  return (
    <>
      <Select
        label="Terrain"
        testId="terrain"
        value={terrain.kind}
        options={kinds.map(({ kind }) => ({ value: kind, label: kind }))}
        onChange={(kind) => set({ kind: kind as TerrainChoice["kind"], values: {} })}
      />
      {parameters.map(({ name, unit, default: usual, least, most, step }) => (
        <Slider
          key={name}
          label={name}
          name={`${name} of the terrain`}
          compact="wide"
          value={terrain.values[name] ?? usual}
          min={least}
          max={most}
          typedMin={-100_000}
          typedMax={100_000}
          step={step}
          unit={unit === "deg" ? "°" : unit}
          testId={`terrain-${name}`}
          onChange={(value, commit) => set({ values: { ...terrain.values, [name]: value } }, commit)}
        />
      ))}
    </>
  );
}
