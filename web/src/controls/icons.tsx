/** Paths on a 24 x 24 grid, stroked in the text colour. */
const PATHS = {
  joints: "M5 19 9 9l8-2M9 9a2 2 0 1 0 .01 0M17 7a2 2 0 1 0 .01 0M5 19a1.5 1.5 0 1 0 .01 0",
  body: "M7 9h10l2 6H5zM12 2v5M10 4l2-2 2 2M12 17v5M10 20l2 2 2-2",
  walk: "M4 18c0-9 6-9 6 0M10 18c0-9 6-9 6 0M16 18c0-5 2-7 4-8M3 21h18",
  drive: "M12 21a9 9 0 1 0-.01 0M12 15a3 3 0 1 0-.01 0M12 3v6M4.5 16.5l5-3M19.5 16.5l-5-3",
  loads: "M4 21V11M10 21V4M16 21v-8M21 21H3M20 8V3M18 5l2-2 2 2",
  robot: "M9 8h6v8H9zM9 9 5 6 3 11M9 12H3M9 15l-4 3-2-4M15 9l4-3 2 5M15 12h6M15 15l4 3 2-4",
  sources: "M4 5c3-1 6-1 8 1 2-2 5-2 8-1v14c-3-1-6-1-8 1-2-2-5-2-8-1zM12 6v14",
  undo: "M9 7 4 12l5 5M4 12h10a6 6 0 0 1 6 6",
  redo: "m15 7 5 5-5 5M20 12H10a6 6 0 0 0-6 6",
  link: "M10 14a4 4 0 0 0 6 0l3-3a4 4 0 0 0-6-6l-1 1M14 10a4 4 0 0 0-6 0l-3 3a4 4 0 0 0 6 6l1-1",
  camera: "M4 8h3l2-3h6l2 3h3v11H4zM12 17a4 4 0 1 0-.01 0",
  sun: "M12 16a4 4 0 1 0-.01 0M12 3v2M12 19v2M3 12h2M19 12h2M5.6 5.6 7 7M17 17l1.4 1.4M5.6 18.4 7 17M17 7l1.4-1.4",
  moon: "M20 14A8.5 8.5 0 1 1 10 4a7 7 0 0 0 10 10z",
  play: "M8 5v14l11-7z",
  pause: "M8 5v14M16 5v14",
  back: "M18 6v12l-9-6zM6 6v12",
  forward: "M6 6v12l9-6zM18 6v12",
  copy: "M9 9h11v11H9zM15 9V4H4v11h5",
  save: "M12 4v11M7 11l5 5 5-5M4 20h16",
  reset: "M5 5v5h5M5.5 10A8 8 0 1 1 4 14",
  check: "m5 13 4 4L19 7",
} as const;

export type IconName = keyof typeof PATHS;

/** A decorative icon; a button without text needs an accessible name. */
export function Icon({ name }: { name: IconName }) {
  return (
    <svg
      viewBox="0 0 24 24"
      width="20"
      height="20"
      fill="none"
      stroke="currentColor"
      strokeWidth="1.8"
      strokeLinecap="round"
      strokeLinejoin="round"
      aria-hidden="true"
      focusable="false"
    >
      <path d={PATHS[name]} />
    </svg>
  );
}
