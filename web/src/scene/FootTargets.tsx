import { useRef } from "react";
import type { Mesh } from "three";

import { footOf, type Shape } from "./frame";
import { setLine, useLine } from "./lines";
import type { Palette } from "./palette";
import { useStage } from "./useStage";

/** Target positions of feet that are out of reach, and their distance from the feet. */
export function FootTargets({ shape, palette }: { shape: Shape; palette: Palette }) {
  return shape.names.map((name, leg) => (
    <Goal
      key={name}
      leg={leg}
      radius={(shape.footRadius[leg] ?? 0) || shape.reach * 0.02}
      palette={palette}
    />
  ));
}

function Goal({ leg, radius, palette }: { leg: number; radius: number; palette: Palette }) {
  const line = useLine({ colour: palette.trouble, width: 2.5, onTop: true });
  const ball = useRef<Mesh>(null);
  useStage((frame) => {
    const goal = frame.trouble[leg]?.goal ?? null;
    setLine(line, goal ? [...footOf(frame, leg), ...goal] : []);
    if (!ball.current) return;
    ball.current.visible = goal !== null;
    if (goal) ball.current.position.set(...goal);
  });
  return (
    <group>
      <primitive object={line} />
      <mesh ref={ball} renderOrder={4} visible={false}>
        <sphereGeometry args={[radius, 16, 12]} />
        <meshBasicMaterial color={palette.trouble} transparent opacity={0.6} depthTest={false} wireframe />
      </mesh>
    </group>
  );
}
