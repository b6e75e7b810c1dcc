import { useSyncExternalStore } from "react";

const coarse = () => window.matchMedia("(pointer: coarse)");

function subscribe(changed: () => void): () => void {
  const query = coarse();
  query.addEventListener("change", changed);
  return () => query.removeEventListener("change", changed);
}

/** Whether the main pointer is a finger: such a device usually has neither keys nor a place to drop files from. */
export function useTouch(): boolean {
  return useSyncExternalStore(subscribe, () => coarse().matches);
}
