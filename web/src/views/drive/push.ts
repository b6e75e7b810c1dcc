/** What the visitor wishes the robot to do, as shares of the chosen top speeds: forward, left, turning left. */
export interface Push {
  forward: number;
  left: number;
  turn: number;
}

export const STILL: Push = { forward: 0, left: 0, turn: 0 };

/** What of a stick's middle counts as nothing: sticks do not come back exactly. */
const DEAD = 0.12;

/** A stick's position within its circle, with a dead middle from which it grows steadily. */
export function stickPush(x: number, y: number): { x: number; y: number } {
  const length = Math.hypot(x, y);
  if (length <= DEAD) return { x: 0, y: 0 };
  const share = (Math.min(1, length) - DEAD) / (1 - DEAD) / length;
  return { x: x * share, y: y * share };
}

const KEYS: Record<string, Partial<Push>> = {
  w: { forward: 1 },
  s: { forward: -1 },
  a: { left: 1 },
  d: { left: -1 },
  q: { turn: 1 },
  e: { turn: -1 },
};

/** Whether a key drives. */
export function isDriveKey(key: string): boolean {
  return key.toLowerCase() in KEYS;
}

/** The push of the keys that are held; two at once are not faster than one. */
export function keyPush(held: ReadonlySet<string>): Push {
  let { forward, left, turn } = STILL;
  for (const key of held) {
    const push = KEYS[key] ?? {};
    forward += push.forward ?? 0;
    left += push.left ?? 0;
    turn += push.turn ?? 0;
  }
  const length = Math.max(1, Math.hypot(forward, left));
  return { forward: forward / length, left: left / length, turn };
}

/** The push of a gamepad with the standard layout: left stick walks, right stick turns. */
export function gamepadPush(axes: readonly number[]): Push {
  const walk = stickPush(axes[0] ?? 0, axes[1] ?? 0);
  const turn = stickPush(axes[2] ?? 0, 0);
  return { forward: -walk.y || 0, left: -walk.x || 0, turn: -turn.x || 0 };
}

/** All pushes together, each within its bounds. */
export function sumOf(pushes: readonly Push[]): Push {
  const total = pushes.reduce(
    (sum, push) => ({
      forward: sum.forward + push.forward,
      left: sum.left + push.left,
      turn: sum.turn + push.turn,
    }),
    STILL,
  );
  const length = Math.max(1, Math.hypot(total.forward, total.left));
  return {
    forward: total.forward / length,
    left: total.left / length,
    turn: Math.max(-1, Math.min(1, total.turn)),
  };
}

export function isStill({ forward, left, turn }: Push): boolean {
  return forward === 0 && left === 0 && turn === 0;
}
