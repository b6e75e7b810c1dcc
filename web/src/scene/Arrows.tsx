import { useMemo, useRef } from "react";
import { Quaternion, Vector3, type Group } from "three";

import { footOf, type Frame, type Shape } from "./frame";
import type { Palette } from "./palette";
import { useStage } from "./useStage";

const UP = new Vector3(0, 1, 0);

interface Props {
  shape: Shape;
  palette: Palette;
}

/** Contact forces of the ground on the feet. The longest arrow is about half as long as a leg. */
export function Arrows({ shape, palette }: Props) {
  const groups = useRef<(Group | null)[]>([]);
  const direction = useMemo(() => new Vector3(), []);
  const turned = useMemo(() => new Quaternion(), []);
  const thick = shape.reach * 0.011;
  const largest = useRef(0);

  useStage((frame) => {
    largest.current = Math.max(largest.current, 1e-6, ...lengths(frame));
    groups.current.forEach((group, leg) => {
      if (!group) return;
      const force = frame.forces?.subarray(leg * 3, leg * 3 + 3);
      direction.set(force?.[0] ?? 0, force?.[1] ?? 0, force?.[2] ?? 0);
      const newtons = direction.length();
      const length = (newtons / largest.current) * shape.reach * 0.5;
      group.visible = length > thick * 2;
      if (!group.visible) return;
      group.position.set(...footOf(frame, leg));
      group.quaternion.copy(turned.setFromUnitVectors(UP, direction.divideScalar(newtons)));
      const head = Math.min(thick * 6, length * 0.5);
      const [shaft, tip] = group.children;
      shaft?.scale.set(1, length - head, 1);
      shaft?.position.set(0, (length - head) / 2, 0);
      tip?.scale.set(1, head, 1);
      tip?.position.set(0, length - head / 2, 0);
    });
  });

  return (
    <group name="forces">
      {shape.names.map((name, leg) => (
        <group
          key={name}
          ref={(group) => {
            groups.current[leg] = group;
          }}
        >
          <mesh>
            <cylinderGeometry args={[thick, thick, 1, 16]} />
            <meshStandardMaterial color={palette.force} roughness={0.7} />
          </mesh>
          <mesh>
            <coneGeometry args={[thick * 2.4, 1, 20]} />
            <meshStandardMaterial color={palette.force} roughness={0.7} />
          </mesh>
        </group>
      ))}
    </group>
  );
}

function lengths({ forces }: Frame): number[] {
  if (!forces) return [];
  return Array.from({ length: forces.length / 3 }, (_, leg) =>
    Math.hypot(...forces.subarray(leg * 3, leg * 3 + 3)),
  );
}
