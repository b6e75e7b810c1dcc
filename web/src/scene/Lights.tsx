import { useRef } from "react";
import type { DirectionalLight } from "three";

import type { Palette } from "./palette";
import { useStage } from "./useStage";

/** Directional and ambient light. The directional light moves with the robot, for a sharp shadow. */
export function Lights({ palette, reach }: { palette: Palette; reach: number }) {
  const sun = useRef<DirectionalLight>(null);
  const half = reach * 2.2;
  useStage(({ position: [x, y] }) => {
    sun.current?.position.set(x - reach * 0.9, y - reach * 1.1, reach * 3.2);
    sun.current?.target.position.set(x, y, 0);
    sun.current?.target.updateMatrixWorld();
  });
  return (
    <group>
      <hemisphereLight args={["#ffffff", palette.gridCoarse, palette.sky]} up={[0, 0, 1]} />
      <directionalLight
        ref={sun}
        castShadow
        intensity={palette.sun}
        shadow-mapSize={[1024, 1024]}
        shadow-bias={-0.0005}
        shadow-normalBias={0.8}
      >
        <orthographicCamera attach="shadow-camera" args={[-half, half, half, -half, 1, reach * 8]} />
      </directionalLight>
    </group>
  );
}
