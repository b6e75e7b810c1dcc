/** Severity of a class of servos, which determines its colour; the same as `severity_of` in tarsus.load.verdict. */
export function severityOf(grade: string): "good" | "warn" | "bad" {
  if (grade === "marginal" || grade === "unknown") return "warn";
  return grade === "good" ? "good" : "bad";
}
