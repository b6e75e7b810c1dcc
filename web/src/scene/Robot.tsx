import { BodyModel } from "./BodyModel";
import type { Shape } from "./frame";
import { LegModel } from "./LegModel";
import type { Palette } from "./palette";

interface Props {
  shape: Shape;
  colours: readonly string[];
  palette: Palette;
}

/** The robot, drawn from the points of its legs; no meshes are needed. */
export function Robot({ shape, colours, palette }: Props) {
  // Thin enough to see the angles, thick enough to be selected.
  const thick = Math.min(14, Math.max(4, shape.reach * 0.028));
  return (
    <group name="robot">
      <BodyModel shape={shape} thick={thick} palette={palette} />
      {shape.names.map((name, leg) => (
        <LegModel
          key={name}
          leg={leg}
          colour={colours[leg] ?? palette.link}
          footRadius={shape.footRadius[leg] ?? 0}
          thick={thick}
          palette={palette}
        />
      ))}
    </group>
  );
}
