import { useRef, type KeyboardEvent, type PointerEvent } from "react";

interface Props {
  label: string;
  /** Moves sideways only, for turning. */
  flat?: boolean;
  testId: string;
  /** x to the right, y upwards, both within a circle of radius 1; zero when released. */
  onDeflect: (x: number, y: number) => void;
}

const ARROWS: Record<string, readonly [number, number]> = {
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
};

/** A stick for finger, mouse, or arrow keys while it has the focus. It returns to the centre when released. */
export function Stick({ label, flat, testId, onDeflect }: Props) {
  const base = useRef<HTMLDivElement>(null);
  const knob = useRef<HTMLDivElement>(null);
  const pressed = useRef(new Set<string>());

  const move = (x: number, y: number) => {
    if (knob.current) knob.current.style.transform = `translate(${x * 36}px, ${-y * 36}px)`;
    onDeflect(x, y);
  };
  const follow = (event: PointerEvent) => {
    const box = base.current?.getBoundingClientRect();
    if (!box || !base.current?.hasPointerCapture(event.pointerId)) return;
    const half = box.width / 2;
    const x = (event.clientX - box.left - half) / half;
    const y = flat ? 0 : (box.top + box.height / 2 - event.clientY) / half;
    const length = Math.max(1, Math.hypot(x, y));
    move(x / length, y / length);
  };
  const keys = (event: KeyboardEvent, down: boolean) => {
    if (!ARROWS[event.key]) return;
    event.preventDefault();
    if (down) pressed.current.add(event.key);
    else pressed.current.delete(event.key);
    const sum = [...pressed.current].reduce<readonly [number, number]>(
      ([x, y], key) => [x + (ARROWS[key]?.[0] ?? 0), y + (ARROWS[key]?.[1] ?? 0)],
      [0, 0],
    );
    const length = Math.max(1, Math.hypot(...sum));
    move(sum[0] / length, flat ? 0 : sum[1] / length);
  };
  return (
    // There is no ARIA role for a stick; arrow keys and a name make it usable without a pointer.
    // eslint-disable-next-line jsx-a11y/no-noninteractive-element-interactions
    <div
      ref={base}
      className={`stick${flat ? " flat" : ""}`}
      role="application"
      aria-roledescription="stick"
      aria-label={`${label}: use the arrow keys`}
      // eslint-disable-next-line jsx-a11y/no-noninteractive-tabindex
      tabIndex={0}
      data-testid={testId}
      onPointerDown={(event) => {
        event.currentTarget.setPointerCapture(event.pointerId);
        follow(event);
      }}
      onPointerMove={follow}
      onPointerUp={() => move(0, 0)}
      onPointerCancel={() => move(0, 0)}
      onKeyDown={(event) => keys(event, true)}
      onKeyUp={(event) => keys(event, false)}
      onBlur={() => {
        pressed.current.clear();
        move(0, 0);
      }}
    >
      <div ref={knob} className="knob" />
    </div>
  );
}
