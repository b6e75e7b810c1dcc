import { setConsoleFunction } from "three";

/** Deprecated in three.js, and still made by react-three-fiber; nothing here uses it. */
const DEPRECATED = "THREE.Clock:";

/** Print the messages of three.js, without a warning that is about a package and not about this page. */
export function beginConsole(): void {
  setConsoleFunction((type: "log" | "warn" | "error", message: string, ...more: unknown[]) => {
    if (!message.startsWith(DEPRECATED)) console[type](message, ...more);
  });
}
