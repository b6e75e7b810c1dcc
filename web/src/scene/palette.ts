/** Colours of the scene. Those of the page are in theme.css, which WebGL can't read. */
export interface Palette {
  background: string;
  ground: string;
  gridFine: string;
  gridCoarse: string;
  gridText: string;
  axisX: string;
  axisY: string;
  body: string;
  deck: string;
  link: string;
  joint: string;
  support: string;
  unstable: string;
  trouble: string;
  force: string;
  workspace: string;
  ghost: string;
  terrain: string;
  mark: string;
  shadow: number;
  sun: number;
  sky: number;
}

export const LIGHT: Palette = {
  background: "#e9eef2",
  ground: "#e9eef2",
  gridFine: "#d5dde3",
  gridCoarse: "#b4c1ca",
  gridText: "#52636e",
  axisX: "#b5473c",
  axisY: "#3c7d4f",
  body: "#3f5d72",
  deck: "#567a93",
  link: "#c3ced6",
  joint: "#4a5d6a",
  support: "#1f8a4c",
  unstable: "#c4202f",
  trouble: "#d01c2c",
  force: "#7a3fb0",
  workspace: "#0b6e8f",
  ghost: "#1d6fd1",
  terrain: "#dfe7ec",
  mark: "#ffb000",
  shadow: 0.28,
  sun: 2.4,
  sky: 1.7,
};

export const DARK: Palette = {
  background: "#12191f",
  ground: "#12191f",
  gridFine: "#1d2830",
  gridCoarse: "#34444f",
  gridText: "#93a6b2",
  axisX: "#e0796e",
  axisY: "#74b888",
  body: "#557389",
  deck: "#6d8fa6",
  link: "#aebbc4",
  joint: "#5e7482",
  support: "#4cc38a",
  unstable: "#ff6b74",
  trouble: "#ff5a63",
  force: "#c39bf0",
  workspace: "#4cc2e0",
  ghost: "#6fb1ff",
  terrain: "#33414b",
  mark: "#ffc24d",
  shadow: 0.55,
  sun: 2.0,
  sky: 1.1,
};

// Colours of Okabe and Ito, as in the figures: cool on the left, warm on the right, from front to rear.
const LEFT = ["#0072B2", "#56B4E9", "#009E73", "#332288"];
const RIGHT = ["#D55E00", "#E69F00", "#CC79A7", "#882255"];

/** A colour for each leg, by the position of its mount ([x, y, z] in mm, y to the left). */
export function legColours(mounts: readonly (readonly number[])[]): string[] {
  const colours = mounts.map(() => "");
  for (const [choice, isSide] of [
    [LEFT, (y: number) => y > 0],
    [RIGHT, (y: number) => y <= 0],
  ] as const) {
    mounts
      .map((mount, leg) => ({ leg, x: mount[0] ?? 0, y: mount[1] ?? 0 }))
      .filter(({ y }) => isSide(y))
      .sort((a, b) => b.x - a.x)
      .forEach(({ leg }, place) => (colours[leg] = choice[place % choice.length] ?? ""));
  }
  return colours;
}
