import { setLine, useLine } from "./lines";
import type { Palette } from "./palette";
import { useEffect } from "react";

/** Centre of a curved walk: a cross on the ground, and the radius to the start of the path. */
export function Centre({ at, palette }: { at: readonly [number, number]; palette: Palette }) {
  const spoke = useLine({ colour: palette.workspace, width: 1.5, opacity: 0.7 });
  const [x, y] = at;
  useEffect(() => setLine(spoke, [x, y, 1, 0, 0, 1]), [spoke, x, y]);
  return (
    <group name="centre">
      <primitive object={spoke} />
      <mesh position={[x, y, 1]} renderOrder={3}>
        <ringGeometry args={[9, 13, 32]} />
        <meshBasicMaterial color={palette.workspace} />
      </mesh>
      <mesh position={[x, y, 1]} renderOrder={3}>
        <circleGeometry args={[3, 16]} />
        <meshBasicMaterial color={palette.workspace} />
      </mesh>
    </group>
  );
}
