import { Html } from "@react-three/drei";
import { useRef, useState } from "react";
import type { Group } from "three";

import { footOf, pointOf, type Frame, type LegTrouble, type Shape } from "./frame";
import { useStage } from "./useStage";

interface Props {
  shape: Shape;
  colours: readonly string[];
  /** Whether each leg bears its short name. */
  names: boolean;
}

/** What is written into the picture: the legs' names, why a leg can't, and the margin of stability. */
export function Notes({ shape, colours, names }: Props) {
  return (
    <group>
      {shape.short.map((code, leg) => (
        <LegNote key={code} leg={leg} code={code} colour={colours[leg] ?? ""} named={names} />
      ))}
      <Margin />
    </group>
  );
}

function LegNote({
  leg,
  code,
  colour,
  named,
}: {
  leg: number;
  code: string;
  colour: string;
  named: boolean;
}) {
  const group = useRef<Group>(null);
  const [trouble, setTrouble] = useState<LegTrouble | null>(null);
  useStage((frame) => {
    const [fx, fy] = footOf(frame, leg);
    const [kx, ky, kz] = pointOf(frame, leg, 2);
    group.current?.position.set(kx * 0.6 + fx * 0.4, ky * 0.6 + fy * 0.4, kz + 34);
    const now = frame.trouble[leg] ?? null;
    if (now?.short !== trouble?.short) setTrouble(now);
  });
  if (!named && !trouble) return <group ref={group} />;
  return (
    <group ref={group}>
      <Html center zIndexRange={[8, 0]} className="note" aria-hidden="true">
        {trouble ? (
          <span className="note-trouble">
            <b>⚠ {code}</b> {trouble.short}
          </span>
        ) : (
          <span className="note-leg">
            <i style={{ background: colour }} />
            {code}
          </span>
        )}
      </Html>
    </group>
  );
}

function Margin() {
  const group = useRef<Group>(null);
  const text = useRef<HTMLSpanElement>(null);
  useStage((frame) => {
    if (!group.current || !text.current) return;
    const shown = frame.com !== null && frame.margin !== null;
    text.current.hidden = !shown;
    if (!frame.com || frame.margin === null) return;
    group.current.position.set(frame.com[0], frame.com[1], 2);
    text.current.textContent = marginText(frame);
    text.current.classList.toggle("bad", frame.margin < 0);
  });
  return (
    <group ref={group}>
      <Html zIndexRange={[7, 0]} className="note" aria-hidden="true">
        <span ref={text} className="note-margin" />
      </Html>
    </group>
  );
}

function marginText({ margin }: Frame): string {
  if (margin === null) return "";
  return margin < 0 ? `falls: ${margin.toFixed(0)} mm` : `${margin.toFixed(0)} mm`;
}
