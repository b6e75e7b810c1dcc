import { useEffect, useRef } from "react";
import uPlot from "uplot";

import { useTheme } from "../app/theme";

export interface Line {
  label: string;
  colour: string;
  values: ArrayLike<number>;
  /** A limit, drawn as a dashed line. */
  dashed?: boolean;
}

interface Props {
  /** Content and most important value, read by screen readers instead of the plot. */
  summary: string;
  x: ArrayLike<number>;
  lines: readonly Line[];
  unit: string;
  height?: number;
  /** Called on a click, with the time [s]. */
  onPick?: (x: number) => void;
  /** Called with a function that moves the time mark, and with null at the end. */
  onMark?: (mark: ((x: number) => void) | null) => void;
}

/** Lines over time, drawn by uPlot on a canvas, which is fast for ten thousand samples. */
export function Plot({ summary, x, lines, unit, height = 150, onPick, onMark }: Props) {
  const box = useRef<HTMLDivElement>(null);
  const theme = useTheme((state) => state.theme);
  const latest = useRef({ onPick, onMark });
  useEffect(() => {
    latest.current = { onPick, onMark };
  });

  useEffect(() => {
    const element = box.current;
    if (!element) return;
    const mark = document.createElement("div");
    mark.className = "plot-mark";
    const data = [Array.from(x), ...lines.map((line) => Array.from(line.values))] as uPlot.AlignedData;
    const plot = new uPlot(options(element.clientWidth, height, lines, unit), data, element);
    plot.over.append(mark);
    const pick = () => {
      const at = plot.cursor.left ?? -1;
      if (at >= 0) latest.current.onPick?.(plot.posToVal(at, "x"));
    };
    plot.over.addEventListener("click", pick);
    latest.current.onMark?.((at) => {
      mark.style.transform = `translateX(${plot.valToPos(at, "x").toFixed(1)}px)`;
    });
    const watch = new ResizeObserver(() => plot.setSize({ width: element.clientWidth, height }));
    watch.observe(element);
    return () => {
      latest.current.onMark?.(null);
      watch.disconnect();
      plot.destroy();
    };
  }, [x, lines, unit, height, theme]);

  return <div ref={box} className="plot" role="img" aria-label={summary} />;
}

function options(width: number, height: number, lines: readonly Line[], unit: string): uPlot.Options {
  const style = getComputedStyle(document.documentElement);
  const [ink, grid] = [style.getPropertyValue("--muted"), style.getPropertyValue("--line")];
  const font = "11px system-ui, sans-serif";
  const axis = { stroke: ink, font, grid: { stroke: grid, width: 1 }, ticks: { show: false } };
  return {
    width,
    height,
    legend: { show: false },
    cursor: { y: false, drag: { x: false, y: false }, points: { show: false } },
    scales: { x: { time: false } },
    axes: [
      { ...axis, size: 24, values: (_, splits) => splits.map((split) => `${split} s`) },
      { ...axis, size: 54, values: (_, splits) => splits.map((split) => `${split} ${unit}`) },
    ],
    series: [
      {},
      ...lines.map((line) => ({
        label: line.label,
        stroke: line.colour,
        width: line.dashed ? 1.2 : 1.6,
        ...(line.dashed ? { dash: [6, 4] } : {}),
        points: { show: false },
      })),
    ],
  };
}
