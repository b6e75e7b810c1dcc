import { describe, expect, it } from "vitest";

import { stanceSpans } from "./spans";

describe("when a foot is down", () => {
  const walk = { rate_hz: 10, contacts: ["10", "11", "01", "11", "10"] };

  it("is from where it stands to where it is lifted, and to the end", () => {
    expect(stanceSpans(walk, 0)).toEqual([
      [0, 0.2],
      [0.3, 0.4],
    ]);
    expect(stanceSpans(walk, 1)).toEqual([[0.1, 0.4]]);
  });

  it("is never for a foot that never stands", () => {
    expect(stanceSpans({ rate_hz: 10, contacts: ["0", "0"] }, 0)).toEqual([]);
  });
});
