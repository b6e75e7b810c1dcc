import { useEffect, useRef, type RefObject } from "react";

/**
 * Be told when an input comes to rest: the browser's own "change", which React's onChange is not (that one is "input").
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
