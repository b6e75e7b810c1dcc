import { describe, expect, it } from "vitest";

import { angleText } from "../views/angleText";
import {
  apart,
  decimalsOf,
  fixed,
  rangeText,
  significant,
  stepped,
  typedNumber,
  unbroken,
  withUnit,
} from "./numbers";

describe("numbers", () => {
  it("have as many decimals as their step", () => {
    expect([1, 5, 0.5, 0.25, 0.01, 100].map(decimalsOf)).toEqual([0, 0, 1, 2, 2, 0]);
  });

  it("are never minus zero", () => {
    expect(fixed(-0.001, 1)).toBe("0.0");
    expect(fixed(-0.06, 1)).toBe("-0.1");
  });

  it("are shown as a dash if unknown", () => {
    expect(withUnit(null, 1, "mm")).toBe("–");
    expect(withUnit(Infinity, 1, "mm")).toBe("–");
    expect(withUnit(12.345, 1, "mm")).toBe("12.3\u00a0mm");
  });

  it("stay on a line with their units", () => {
    expect(withUnit(1.5, 2, "N m")).toBe("1.50\u00a0N\u00a0m");
    expect(unbroken("factor 1.66, 1.98 N m short of factor 3 at 2 s")).toBe(
      "factor 1.66, 1.98\u00a0N\u00a0m short of factor 3 at 2\u00a0s",
    );
  });

  it("may be typed with a decimal comma; incomplete numbers are rejected", () => {
    expect(["1,5", " -3 ", ".5", "1e3", "−2"].map(typedNumber)).toEqual([1.5, -3, 0.5, 1000, -2]);
    expect(["", "-", "1,2,3", "abc", "Infinity", "1e999"].map(typedNumber)).toEqual(Array(6).fill(null));
  });
});

describe("significant digits", () => {
  it("are shown without exponents", () => {
    expect([0.00006144, 1234567, 0, -0.5, 12].map((value) => significant(value, 4))).toEqual([
      "0.00006144",
      "1234567",
      "0",
      "-0.5000",
      "12.00",
    ]);
  });

  it("are as many as it takes to tell two numbers apart", () => {
    expect(apart(0.0001233, 0.0000614)).toEqual(["0.0001233", "0.00006140"]);
    expect(apart(100.00001, 100.00002)).toEqual(["100.00001", "100.00002"]);
    expect(apart(2, 2)).toEqual(["2.000", "2.000"]);
  });
});

describe("a number field", () => {
  it("says what it accepts", () => {
    expect(rangeText(0, 5000)).toBe("must be from 0 to 5000");
    expect([rangeText(1, undefined), rangeText(undefined, 9), rangeText(undefined, undefined)]).toEqual([
      "must be at least 1",
      "must be at most 9",
      "must be a number",
    ]);
  });

  it("steps within its range", () => {
    expect([stepped(0.1, 0.2), stepped(4, 5, 0, 6), stepped(1, -5, 0)]).toEqual([0.3, 6, 0]);
  });
});

describe("the table of angles", () => {
  it("is copied with tabs, as spreadsheets expect", () => {
    expect(angleText(["LF", "RF"], [1, 2, 3, 4, 5, -6.12345])).toBe(
      "leg\tcoxa_deg\tfemur_deg\ttibia_deg\nLF\t1.0000\t2.0000\t3.0000\nRF\t4.0000\t5.0000\t-6.1235",
    );
  });
});
