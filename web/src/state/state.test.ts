import { describe, expect, it } from "vitest";

import { readAddress, socketAddress, writeAddress } from "./address";
import { backoff } from "./backoff";
import { advanced, stepped } from "./playback";

describe("address", () => {
  it("has the state in its fragment", () => {
    const href = writeAddress("http://127.0.0.1:8600/?token=abc", "1.q64_-AA", true);
    expect(href).toBe("http://127.0.0.1:8600/?token=abc#s=1.q64_-AA");
    expect(readAddress(href)).toEqual({ token: "abc", state: "1.q64_-AA" });
  });

  it("leaves out the token", () => {
    expect(writeAddress("http://h/?token=abc#s=old", "new", false)).toBe("http://h/#s=new");
  });

  it("may be without a state", () => {
    expect(readAddress("http://h/").state).toBeNull();
    expect(writeAddress("http://h/#s=x", null, true)).toBe("http://h/");
  });

  it("gives the socket on the page's host, with the token and without the state", () => {
    expect(socketAddress("http://h:1/?token=a%20b#s=x")).toBe("ws://h:1/session/1?token=a+b");
    expect(socketAddress("https://h/")).toBe("wss://h/session/1");
  });
});

describe("backoff", () => {
  it("doubles, up to a bound", () => {
    const waits = [0, 1, 2, 3, 20].map((attempt) => backoff(attempt, () => 0.5));
    expect(waits).toEqual([400, 800, 1600, 3200, 15_000]);
  });

  it("varies by a quarter in either direction", () => {
    expect(backoff(0, () => 0)).toBe(300);
    expect(backoff(0, () => 1)).toBe(500);
  });
});

describe("playback", () => {
  const playback = { time: 1, playing: true, speed: 2, loop: true };

  it("runs at its speed", () => {
    expect(advanced(playback, 0.25, 10).time).toBeCloseTo(1.5);
  });

  it("restarts in a loop, else stops at the end", () => {
    const looped = advanced({ ...playback, time: 9.9 }, 0.1, 10);
    expect(looped.time).toBeCloseTo(0.1);
    expect(looped.playing).toBe(true);
    expect(advanced({ ...playback, time: 9.9, loop: false }, 0.1, 10)).toMatchObject({
      time: 10,
      playing: false,
    });
  });

  it("steps from sample to sample", () => {
    expect(stepped(0.1, 1, 100, 5)).toBeCloseTo(0.11);
    expect(stepped(0.105, 1, 100, 5)).toBeCloseTo(0.11);
    expect(stepped(0.105, -1, 100, 5)).toBeCloseTo(0.1);
    expect(stepped(0.1, -1, 100, 5)).toBeCloseTo(0.09);
    expect(stepped(0, -1, 100, 5)).toBe(0);
    expect(stepped(5, 1, 100, 5)).toBe(5);
  });
});
