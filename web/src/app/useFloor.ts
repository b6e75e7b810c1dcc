import { change } from "../state/session";
import { useStudio, type View } from "../state/store";

/** What a click on the floor means: in the view Walk, the centre that a curve goes round. */
export function useFloor(view: View): ((x: number, y: number) => void) | undefined {
  const curve = useStudio((studio) => studio.state?.walk.path.way === "curve");
  if (view !== "walk" || !curve) return undefined;
  return (x, y) => {
    const path = useStudio.getState().state?.walk.path;
    if (path?.way !== "curve") return;
    change("walk", { path: { ...path, centre_mm: [Math.round(x), Math.round(y)] } });
  };
}
