import { useFrame, useThree } from "@react-three/fiber";
import { useEffect } from "react";

import { stage } from "./stage";

/** Advances the stage before each frame, and asks for the next while something moves. */
export function Conductor() {
  const invalidate = useThree((state) => state.invalidate);
  useFrame((_, dt) => {
    // After a rest the clock has run on: that time was not shown.
    if (stage.advance(Math.min(dt, 0.05))) invalidate();
  }, -1);
  useEffect(() => invalidate());
  return null;
}
