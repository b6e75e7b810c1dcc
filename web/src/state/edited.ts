/** Which input of a message the user changed last: a refusal stands beside it. */

/** Path of the first value that differs, as in error messages: path.centre_mm[0]; null where nothing does. */
export function changedKey(before: unknown, after: unknown, path = ""): string | null {
  if (Object.is(before, after)) return null;
  if (!isTree(before) || !isTree(after) || Array.isArray(before) !== Array.isArray(after)) return path;
  const keys = new Set([...Object.keys(after), ...Object.keys(before)]);
  for (const key of keys) {
    const inner = Array.isArray(after) ? `${path}[${key}]` : path ? `${path}.${key}` : key;
    const found = changedKey(before[key], after[key], inner);
    if (found !== null) return found;
  }
  return null;
}

function isTree(value: unknown): value is Record<string, unknown> {
  return typeof value === "object" && value !== null;
}
