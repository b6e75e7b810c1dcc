import { useRef, type KeyboardEvent, type PointerEvent } from "react";

interface Props {
  label: string;
  /** Only sideways: for turning. */
  flat?: boolean;
  testId: string;
  /** x to the right, y upwards, both within a circle of radius one; zero when let go. */
  onPush: (x: number, y: number) => void;
}

const ARROWS: Record<string, readonly [number, number]> = {
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
};

/** A stick for finger, mouse, or arrow keys while it has the focus. It comes back to the middle by itself. */
export function Stick({ label, flat, testId, onPush }: Props) {
  const base = useRef<HTMLDivElement>(null);
  const knob = useRef<HTMLDivElement>(null);
  const held = useRef(new Set<string>());

  const put = (x: number, y: number) => {
    if (knob.current) knob.current.style.transform = `translate(${x * 36}px, ${-y * 36}px)`;
    onPush(x, y);
  };
  const follow = (event: PointerEvent) => {
    const box = base.current?.getBoundingClientRect();
    if (!box || !base.current?.hasPointerCapture(event.pointerId)) return;
    const half = box.width / 2;
    const x = (event.clientX - box.left - half) / half;
    const y = flat ? 0 : (box.top + box.height / 2 - event.clientY) / half;
    const length = Math.max(1, Math.hypot(x, y));
    put(x / length, y / length);
  };
  const keys = (event: KeyboardEvent, down: boolean) => {
    if (!ARROWS[event.key]) return;
    event.preventDefault();
    if (down) held.current.add(event.key);
    else held.current.delete(event.key);
    const sum = [...held.current].reduce<readonly [number, number]>(
      ([x, y], key) => [x + (ARROWS[key]?.[0] ?? 0), y + (ARROWS[key]?.[1] ?? 0)],
      [0, 0],
    );
    const length = Math.max(1, Math.hypot(...sum));
    put(sum[0] / length, flat ? 0 : sum[1] / length);
  };
  return (
    // A stick has no role of its own; arrow keys and a name make it usable without a pointer.
    // eslint-disable-next-line jsx-a11y/no-noninteractive-element-interactions
    <div
      ref={base}
      className={`stick${flat ? " flat" : ""}`}
      role="application"
      aria-roledescription="stick"
      aria-label={`${label}. Arrow keys push it.`}
      // eslint-disable-next-line jsx-a11y/no-noninteractive-tabindex
      tabIndex={0}
      data-testid={testId}
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        follow(event);
      }}
      onPointerMove={follow}
      onPointerUp={() => put(0, 0)}
      onPointerCancel={() => put(0, 0)}
      onKeyDown={(event) => keys(event, true)}
      onKeyUp={(event) => keys(event, false)}
      onBlur={() => {
        held.current.clear();
        put(0, 0);
      }}
    >
      <div ref={knob} className="knob" />
    </div>
  );
}
