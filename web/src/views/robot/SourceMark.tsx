import { useInputs } from "../useInputs";
import { pathText, type KeyPath } from "./document";

const WORDS: Record<string, string> = {
  A: "read in the primary file",
  "A-": "read in the primary file, with uncertainty",
  B: "read in a secondary copy",
  C: "general knowledge",
  guess: "a guess",
};

/** Confidence of a value of the robot file, with its source in the tooltip. */
export function SourceMark({ path }: { path: KeyPath }) {
  const { robot } = useInputs();
  const text = pathText(path.filter((key) => typeof key === "string"));
  const found = robot.dimensions.find(({ key }) => {
    const plain = key.replace(/\[\d+\]/g, "");
    return plain === text || text.startsWith(`${plain}.`);
  });
  if (!found?.confidence) return null;
  const words = WORDS[found.confidence] ?? found.confidence;
  return (
    <span className="badge" title={`${words}: ${found.source ?? ""}. ${found.note ?? ""}`}>
      {found.confidence}
      <span className="hidden-text">: {words}</span>
    </span>
  );
}
