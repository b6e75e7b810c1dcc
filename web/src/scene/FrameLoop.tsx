import { useFrame, useThree } from "@react-three/fiber";
import { useEffect } from "react";

import { stage } from "./stage";

/** Advances the stage before each frame, and requests the next frame while something moves. */
export function FrameLoop() {
  const invalidate = useThree((state) => state.invalidate);
  useFrame((_, dt) => {
    // The time since the last frame includes the pause without frames.
    if (stage.advance(Math.min(dt, 0.05))) invalidate();
  }, -1);
  useEffect(() => invalidate());
  return null;
}
