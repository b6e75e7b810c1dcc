import type { MathNode } from "../../protocol";

/** Letters that fit on a line of the panel. */
const WIDE = 58;

/** Length of a formula as text. */
export function lengthOf(node: MathNode): number {
  return (node.text ?? "").length + node.children.reduce((sum, child) => sum + lengthOf(child), 0);
}

/** A long sum as several lines, each but the first with its sign before it; anything else is one line. */
export function linesOf(node: MathNode, wide = WIDE): MathNode[] {
  if (lengthOf(node) <= wide) return [node];
  const lines: MathNode[][] = [[]];
  let length = 0;
  for (const part of parts(node)) {
    const more = part.reduce((sum, each) => sum + lengthOf(each), 0);
    if (length > 0 && length + more > wide) {
      lines.push([]);
      length = 0;
    }
    lines.at(-1)?.push(...part);
    length += more;
  }
  return lines.map((children) => ({ tag: "mrow", text: null, children }));
}

/** The terms of a sum, each with the sign or the equals sign before it. */
function parts(node: MathNode): MathNode[][] {
  const [left, sign, right, ...more] = node.children;
  const isSplit = node.tag === "mrow" && sign?.tag === "mo" && ["+", "−", "="].includes(sign.text ?? "");
  if (!isSplit || !left || !right || more.length > 0) return [[node]];
  const [first = [], ...rest] = sign.text === "−" ? [[right]] : parts(right);
  return [...parts(left), [sign, ...first], ...rest];
}
