import { createElement, type ReactNode } from "react";

import type { MathNode } from "../../protocol";
import { linesOf } from "./lines";

/** A formula in MathML, which screen readers read too; a long sum on a line of its own takes several. */
export function Maths({ node, block }: { node: MathNode; block?: boolean }) {
  if (block) return linesOf(node).map((line, i) => <Line key={i} node={line} block />);
  return <Line node={node} />;
}

function Line({ node, block }: { node: MathNode; block?: boolean }) {
  return createElement("math", { display: block ? "block" : "inline" }, element(node, 0));
}

function element(node: MathNode, key: number): ReactNode {
  return createElement(node.tag, { key }, node.text ?? undefined, ...node.children.map(element));
}
