import { change } from "../state/session";
import { useStudio, type View } from "../state/store";

/** Handler of clicks on the ground: in the view Walk it sets the centre of a curve. */
export function useFloor(view: View): ((x: number, y: number) => void) | undefined {
  const curve = useStudio((studio) => studio.state?.walk.path.kind === "curve");
  if (view !== "walk" || !curve) return undefined;
  return (x, y) => {
    const path = useStudio.getState().state?.walk.path;
    if (path?.kind !== "curve") return;
    change("walk", { path: { ...path, centre_mm: [Math.round(x), Math.round(y)] } });
  };
}
