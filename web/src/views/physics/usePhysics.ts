import { useEffect } from "react";

import type { PhysicsOptions, TerrainMessage } from "../../protocol";
import { ask } from "../../state/session";
import { useStudio, type View } from "../../state/store";

/** Delay after the last change of the walk, so that a slider is not held up by simulations [ms]. */
const REST = 250;

/** Whether a view shows physics. */
export function useInPhysics(view: View): boolean {
  const on = useStudio((studio) => studio.state?.physics.on === true);
  return on && (view === "walk" || view === "drive");
}

/** The terrain that a view shows; null where there is level ground only. */
export function useTerrain(view: View): TerrainMessage | null {
  const shown = useInPhysics(view);
  const terrain = useStudio((studio) => studio.terrain);
  return shown ? terrain : null;
}

/** Have the walk simulated, once it and the options of physics have been accepted. */
export function useSimulation(view: View): void {
  const shown = useInPhysics(view) && view === "walk";
  const walk = useStudio((studio) => studio.walk);
  const wanted = useStudio(
    ({ busy, failures, simulated, terrain }) =>
      simulated === null &&
      terrain !== null &&
      ![busy.walk, busy.physics, busy.simulate].includes(true) &&
      !failures.walk &&
      !failures.physics &&
      !failures.simulate,
  );
  useEffect(() => {
    if (!shown || !walk || !wanted) return;
    const timer = window.setTimeout(() => ask({ type: "simulate" }), REST);
    return () => window.clearTimeout(timer);
  }, [shown, walk, wanted]);
}

/** A text that changes with the options of physics: with others, a driven robot starts anew. */
export function keyOf(physics: PhysicsOptions | undefined): string {
  return physics?.on ? JSON.stringify(physics) : "planned";
}
