import { useEffect, useRef, type RefObject } from "react";

/**
 * Call a function at the native "change" event of an input, that is, at the end of an edit: React's onChange is "input".
 */
export function useCommit(onRest: (value: number) => void): RefObject<HTMLInputElement | null> {
  const input = useRef<HTMLInputElement>(null);
  const latest = useRef(onRest);
  useEffect(() => {
    latest.current = onRest;
  });
  useEffect(() => {
    const element = input.current;
    if (!element) return;
    const rest = () => latest.current(element.valueAsNumber);
    element.addEventListener("change", rest);
    return () => element.removeEventListener("change", rest);
  }, []);
  return input;
}
