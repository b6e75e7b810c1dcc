import type { BodyState } from "../protocol";
import type { DragEvent } from "../scene/Handles";
import { ask, change } from "../state/session";
import { useStudio } from "../state/store";

/** The body's place when it was grabbed: what is dragged is added to it. */
let before: { from: DragEvent["from"]; body: BodyState } | null = null;

/** A foot or the body has been dragged: the server finds the joint angles. */
export function dragged({ grip, from, to, done }: DragEvent): void {
  if (grip !== "body") {
    ask({ type: "drag_foot", leg: grip, position_mm: [to[0], to[1], Math.max(0, to[2])], commit: done });
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
