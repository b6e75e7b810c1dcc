import { describe, expect, it } from "vitest";

import { stanceSpans } from "./spans";

describe("stance intervals", () => {
  const walk = { rate_hz: 10, contacts: ["10", "11", "01", "11", "10"] };

  it("last from touch-down to lift-off, or to the end", () => {
    expect(stanceSpans(walk, 0)).toEqual([
      [0, 0.2],
      [0.3, 0.4],
    ]);
    expect(stanceSpans(walk, 1)).toEqual([[0.1, 0.4]]);
  });

  it("are empty for a foot that is never in contact", () => {
    expect(stanceSpans({ rate_hz: 10, contacts: ["0", "0"] }, 0)).toEqual([]);
  });
});
