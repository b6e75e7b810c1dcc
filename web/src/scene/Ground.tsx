import { useFrame } from "@react-three/fiber";
import { useMemo, useRef, useState } from "react";
import { BufferAttribute, BufferGeometry, type Group } from "three";

import { GridLabel } from "./GridLabel";
import type { Palette } from "./palette";
import { stage } from "./stage";

/** Half the side length of the drawn part of the ground [mm]. */
const HALF = 3000;
const COARSE = 100;
const FINE = 50;
const PIECE = 500;
/** Distance between labels [mm], and number of labels on each side. */
const LABELS = 200;
const SIDE = 4;

/** The ground: a grid of 50 and 100 mm with coordinates, centred below the robot. */
export function Ground({ palette }: { palette: Palette }) {
  const group = useRef<Group>(null);
  const [[cx, cy], setCentre] = useState<readonly [number, number]>([0, 0]);
  const fine = useMemo(() => gridLines(FINE, (n) => n % (COARSE / FINE) !== 0), []);
  const coarse = useMemo(() => gridLines(COARSE, () => true), []);

  useFrame(() => {
    const [x, y] = stage.current?.position ?? [0, 0];
    const next = [snap(x), snap(y)] as const;
    if (next[0] !== cx || next[1] !== cy) setCentre(next);
  });

  const steps = Array.from({ length: 2 * SIDE + 1 }, (_, i) => (i - SIDE) * LABELS);
  return (
    <group>
      <mesh receiveShadow position={[cx, cy, -0.5]} name="floor">
        <planeGeometry args={[2 * HALF, 2 * HALF]} />
        <shadowMaterial transparent opacity={palette.shadow} />
      </mesh>
      <group ref={group} position={[cx, cy, 0]}>
        <lineSegments geometry={fine}>
          <lineBasicMaterial color={palette.gridFine} />
        </lineSegments>
        <lineSegments geometry={coarse}>
          <lineBasicMaterial color={palette.gridCoarse} />
        </lineSegments>
      </group>
      <Axis palette={palette} along="x" />
      <Axis palette={palette} along="y" />
      {steps.map((step) => (
        <GridLabel
          key={`x${cx + step}`}
          text={`${cx + step}`}
          at={[cx + step, 0]}
          colour={palette.gridText}
        />
      ))}
      {steps
        .filter((step) => cy + step !== 0)
        .map((step) => (
          <GridLabel
            key={`y${cy + step}`}
            text={`${cy + step}`}
            at={[0, cy + step]}
            colour={palette.gridText}
          />
        ))}
      <GridLabel text="x mm" at={[cx + SIDE * LABELS + 90, 0]} colour={palette.axisX} />
      <GridLabel text="y mm" at={[0, cy + SIDE * LABELS + 90]} colour={palette.axisY} />
    </group>
  );
}

function snap(value: number): number {
  return Math.round(value / LABELS) * LABELS;
}

/** The axes through the origin, where the walk starts. */
function Axis({ palette, along }: { palette: Palette; along: "x" | "y" }) {
  const isX = along === "x";
  return (
    <mesh position={[0, 0, 0.2]} rotation={[0, 0, isX ? 0 : Math.PI / 2]}>
      <planeGeometry args={[2 * HALF * 4, 1.6]} />
      <meshBasicMaterial color={isX ? palette.axisX : palette.axisY} transparent opacity={0.55} />
    </mesh>
  );
}

function gridLines(step: number, keep: (n: number) => boolean): BufferGeometry {
  const numbers: number[] = [];
  for (let n = -HALF / step; n <= HALF / step; n++) {
    if (!keep(n)) continue;
    const at = n * step;
    // In segments: some drivers do not draw a line if one of its ends is behind the camera.
    for (let from = -HALF; from < HALF; from += PIECE) {
      const to = from + PIECE;
      numbers.push(at, from, 0, at, to, 0, from, at, 0, to, at, 0);
    }
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new BufferAttribute(new Float32Array(numbers), 3));
  return geometry;
}
