import { useEffect, useMemo, useRef } from "react";

import { footOf, type Frame } from "./frame";
import { makeLine, setLine } from "./lines";
import { roomFor, smoothed } from "./smooth";
import { stage } from "./stage";
import { useStage } from "./useStage";

/** Number of stored positions of each foot, and the distance between them [mm]. */
const MOST = 240;
const APART = 3;

/** Recent paths of the feet while driving: of every frame of the server, however few are drawn, and smooth. */
export function LiveTrails({ colours }: { colours: readonly string[] }) {
  const lines = useMemo(
    () => colours.map((colour) => makeLine({ colour, width: 2, opacity: 0.7 })),
    [colours],
  );
  const trails = useRef<Float32Array[]>([]);
  const curves = useRef<Float32Array[]>([]);
  const changed = useRef(new Set<number>());
  useEffect(
    () => () => {
      lines.forEach((line) => {
        line.geometry.dispose();
        line.material.dispose();
      });
      trails.current = [];
    },
    [lines],
  );
  useEffect(
    () =>
      stage.watchTargets((frame) => {
        frame.contacts.forEach((_, leg) => {
          if (follow((trails.current[leg] ??= filledWith(frame, leg)), frame, leg)) changed.current.add(leg);
        });
      }),
    [],
  );
  useStage(() => {
    changed.current.forEach((leg) => {
      const [line, trail] = [lines[leg], trails.current[leg]];
      if (line && trail) setLine(line, smoothed(trail, (curves.current[leg] ??= roomFor(MOST))));
    });
    changed.current.clear();
  });
  return (
    <group>
      {lines.map((line, leg) => (
        <primitive key={leg} object={line} />
      ))}
    </group>
  );
}

// A constant number of points, so that the line is updated in place.
function filledWith(frame: Frame, leg: number): Float32Array {
  const foot = footOf(frame, leg);
  return new Float32Array(MOST * 3).map((_, i) => foot[i % 3] ?? 0);
}

/** Append the position of the foot if it has moved; returns whether it has. */
function follow(trail: Float32Array, frame: Frame, leg: number): boolean {
  const foot = footOf(frame, leg);
  const end = trail.length - 3;
  const gap = Math.hypot(
    foot[0] - (trail[end] ?? 0),
    foot[1] - (trail[end + 1] ?? 0),
    foot[2] - (trail[end + 2] ?? 0),
  );
  if (gap < APART) return false;
  // A jump is not a step: the robot has been reset.
  if (gap > 40 * APART) trail.set(filledWith(frame, leg));
  trail.copyWithin(0, 3);
  trail.set(foot, end);
  return true;
}
