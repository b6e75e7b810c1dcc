/** Deflection of a stick, a gamepad or keys, as fractions of the top speeds: forward, left, turn to the left. */
export interface Deflection {
  forward: number;
  left: number;
  turn: number;
}

export const CENTRED: Deflection = { forward: 0, left: 0, turn: 0 };

/** Radius of a stick's dead workspace, as a fraction of its range: sticks do not return exactly to the centre. */
const DEAD_ZONE = 0.12;

/** Deflection of a stick at a position within its circle; it grows from 0 at the edge of the dead workspace. */
export function stickDeflection(x: number, y: number): { x: number; y: number } {
  const length = Math.hypot(x, y);
  if (length <= DEAD_ZONE) return { x: 0, y: 0 };
  const factor = (Math.min(1, length) - DEAD_ZONE) / (1 - DEAD_ZONE) / length;
  return { x: x * factor, y: y * factor };
}

const KEYS: Record<string, Partial<Deflection>> = {
  w: { forward: 1 },
  s: { forward: -1 },
  a: { left: 1 },
  d: { left: -1 },
  q: { turn: 1 },
  e: { turn: -1 },
  arrowup: { forward: 1 },
  arrowdown: { forward: -1 },
  arrowleft: { turn: 1 },
  arrowright: { turn: -1 },
};

/** Whether a key drives the robot. */
export function isDriveKey(key: string): boolean {
  return key.toLowerCase() in KEYS;
}

/** Deflection of the pressed keys; two keys together are not faster than one. */
export function keyDeflection(pressed: ReadonlySet<string>): Deflection {
  let { forward, left, turn } = CENTRED;
  for (const key of pressed) {
    const deflection = KEYS[key] ?? {};
    forward += deflection.forward ?? 0;
    left += deflection.left ?? 0;
    turn += deflection.turn ?? 0;
  }
  const length = Math.max(1, Math.hypot(forward, left));
  return { forward: forward / length, left: left / length, turn: Math.max(-1, Math.min(1, turn)) };
}

/** Deflection of a gamepad with the standard layout: left stick walks, right stick turns. */
export function gamepadDeflection(axes: readonly number[]): Deflection {
  const walk = stickDeflection(axes[0] ?? 0, axes[1] ?? 0);
  const turn = stickDeflection(axes[2] ?? 0, 0);
  return { forward: -walk.y || 0, left: -walk.x || 0, turn: -turn.x || 0 };
}

/** Sum of several deflections, limited to the full range. */
export function sumOf(deflections: readonly Deflection[]): Deflection {
  const total = deflections.reduce(
    (sum, each) => ({
      forward: sum.forward + each.forward,
      left: sum.left + each.left,
      turn: sum.turn + each.turn,
    }),
    CENTRED,
  );
  const length = Math.max(1, Math.hypot(total.forward, total.left));
  return {
    forward: total.forward / length,
    left: total.left / length,
    turn: Math.max(-1, Math.min(1, total.turn)),
  };
}

export function isCentred({ forward, left, turn }: Deflection): boolean {
  return forward === 0 && left === 0 && turn === 0;
}
