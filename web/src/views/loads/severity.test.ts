import { describe, expect, it } from "vitest";
import { severityOf } from "./severity";

describe("severity", () => {
  it("is that of the report for every class", () => {
    const classes = ["good", "marginal", "unknown", "stalls or burns", "cannot stand"];
    expect(classes.map(severityOf)).toEqual(["good", "warn", "warn", "bad", "bad"]);
  });
});
