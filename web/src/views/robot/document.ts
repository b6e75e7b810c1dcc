import type { RobotFile } from "../../protocol";

/** Path of a value in a robot file: keys of tables and indices of lists. */
export type KeyPath = readonly (string | number)[];

type Tree = Record<string | number, unknown>;

/** The value at a path, or undefined if it is missing. */
export function valueAt(document: RobotFile, path: KeyPath): unknown {
  return path.reduce<unknown>((at, key) => (isTree(at) ? at[key] : undefined), document);
}

/** The number at a path, or null if it is missing. */
export function numberAt(document: RobotFile, path: KeyPath): number | null {
  const value = valueAt(document, path);
  return typeof value === "number" ? value : null;
}

/** Copy of the document with a value set; missing tables are created, missing lists start as `list`. */
export function withValue(
  document: RobotFile,
  path: KeyPath,
  value: unknown,
  list: readonly number[] = [],
): RobotFile {
  return put(document, path, value, list) as RobotFile;
}

function put(at: unknown, [key, ...rest]: KeyPath, value: unknown, list: readonly number[]): unknown {
  if (key === undefined) return value;
  const copy: Tree =
    typeof key === "number"
      ? ((Array.isArray(at) ? [...(at as unknown[])] : [...list]) as unknown as Tree)
      : isTree(at)
        ? { ...at }
        : {};
  copy[key] = put(copy[key], rest, value, list);
  return copy;
}

/** Copy of the document without a key and without empty tables; missing values have their defaults. */
export function withoutKey(document: RobotFile, path: KeyPath): RobotFile {
  return (drop(document, path) ?? {}) as RobotFile;
}

function drop(at: unknown, [key, ...rest]: KeyPath): unknown {
  if (!isTree(at) || key === undefined) return at;
  // A list is removed as a whole, as it can't lack one number.
  if (typeof rest[0] === "number" && rest.length === 1) return drop(at, [key]);
  const inner = rest.length > 0 ? drop(at[key], rest) : undefined;
  if (Array.isArray(at)) return at.map((entry: unknown, i) => (i === key ? inner : entry));
  const copy = Object.fromEntries(Object.entries(at).filter(([name]) => name !== String(key)));
  if (inner !== undefined && !(isTree(inner) && Object.keys(inner).length === 0)) copy[String(key)] = inner;
  return copy;
}

function isTree(value: unknown): value is Tree {
  return typeof value === "object" && value !== null;
}

/** A path as in error messages: legs[2].position_mm. */
export function pathText(path: KeyPath): string {
  return path.reduce<string>(
    (text, key) => (typeof key === "number" ? `${text}[${key}]` : text ? `${text}.${key}` : key),
    "",
  );
}

/** Copy of the document with these servos in all legs. */
export function withServos(document: RobotFile, coxa: string, femur: string, tibia: string): RobotFile {
  const servo = coxa === femur && femur === tibia ? coxa : { coxa, femur, tibia };
  const bare = document.legs.reduce<RobotFile>(
    (next, _, i) => withoutKey(next, ["legs", i, "servo"]),
    document,
  );
  return withValue(bare, ["leg", "servo"], servo);
}
