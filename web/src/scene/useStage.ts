import { useEffect, useRef } from "react";

import type { Frame } from "./frame";
import { stage } from "./stage";

/** Call a function with every drawn frame, without rendering the component. */
export function useStage(apply: (frame: Frame) => void): void {
  const latest = useRef(apply);
  useEffect(() => {
    latest.current = apply;
    if (stage.current) apply(stage.current);
  });
  useEffect(() => stage.watch((frame) => latest.current(frame)), []);
}
