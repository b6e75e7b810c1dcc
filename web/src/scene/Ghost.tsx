import { useRef } from "react";
import type { Group, Mesh } from "three";

import type { Shape } from "./frame";
import { span } from "./LegModel";
import type { Palette } from "./palette";
import { useStage } from "./useStage";

interface Props {
  shape: Shape;
  palette: Palette;
}

const LINKS = [0, 1, 2] as const;
/** Scale of the body, so that it is inside the one in physics where they coincide. */
const INSET = 0.97;

/** The robot as planned or commanded, translucent, beside the one in physics. */
export function Ghost({ shape, palette }: Props) {
  const all = useRef<Group>(null);
  const body = useRef<Group>(null);
  const links = useRef<(Mesh | null)[]>([]);
  const thick = Math.min(9, Math.max(3, shape.reach * 0.018));
  const size = shape.size ?? bounds(shape);

  useStage(({ ghost }) => {
    if (!all.current) return;
    all.current.visible = ghost !== null;
    if (!ghost) return;
    body.current?.position.set(...ghost.position);
    body.current?.quaternion.set(...ghost.rotation);
    links.current.forEach(
      (link, i) => link && span(link, ghost, Math.floor(i / LINKS.length), i % LINKS.length),
    );
  });

  return (
    <group ref={all} name="ghost">
      <group ref={body}>
        <mesh renderOrder={3}>
          <boxGeometry args={[INSET * size[0], INSET * size[1], INSET * size[2]]} />
          <GhostMaterial palette={palette} />
        </mesh>
      </group>
      {shape.names.flatMap((name, leg) =>
        LINKS.map((link) => (
          <mesh
            key={`${name} ${link}`}
            renderOrder={3}
            ref={(mesh) => {
              links.current[leg * LINKS.length + link] = mesh;
            }}
          >
            <cylinderGeometry args={[thick, thick, 1, 12]} />
            <GhostMaterial palette={palette} />
          </mesh>
        )),
      )}
    </group>
  );
}

function GhostMaterial({ palette }: { palette: Palette }) {
  return <meshBasicMaterial color={palette.ghost} transparent opacity={0.32} depthWrite={false} />;
}

/** The box around the coxa axes, for a body without dimensions. */
function bounds({ mounts }: Shape): readonly [number, number, number] {
  const span = (axis: 0 | 1) => 2 * Math.max(...mounts.map((mount) => Math.abs(mount[axis])));
  return [span(0), span(1), 10];
}
