import type { BodyState } from "../protocol";
import type { DragEvent } from "../scene/Handles";
import { change, dragFoot } from "../state/session";
import { useStudio } from "../state/store";

/** Position of the body at the start of the drag, to which the drag is added. */
let before: { from: DragEvent["from"]; body: BodyState } | null = null;

/** Handle a drag of a foot or of the body: the server solves the inverse kinematics. */
export function dragged({ grip, from, to, done }: DragEvent): void {
  if (grip !== "body") {
    dragFoot(grip, [to[0], to[1], Math.max(0, to[2])], done);
    return;
  }
  const { state } = useStudio.getState();
  if (!state) return;
  if (before?.from !== from) before = { from, body: state.body };
  const { body } = before;
  change(
    "body",
    {
      x_mm: round(body.x_mm + to[0] - from[0]),
      y_mm: round(body.y_mm + to[1] - from[1]),
      z_mm: round(body.z_mm + to[2] - from[2]),
    },
    done,
  );
}

function round(value: number): number {
  return Math.round(value * 10) / 10;
}
