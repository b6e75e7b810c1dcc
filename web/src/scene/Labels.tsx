import { useEffect, useState, type RefObject } from "react";

import type { LegTrouble, Shape } from "./frame";
import { stage } from "./stage";

interface Props {
  layer: RefObject<HTMLDivElement | null>;
  shape: Shape;
  colours: readonly string[];
  /** Whether to show the forces at the feet. */
  forces: boolean;
}

/**
 * Labels over the 3D view: names of the legs, problems of legs, the stability margin, and forces.
 *
 * Hidden from screen readers, as the panel has the same in sentences. `LabelPositions` moves the labels.
 */
export function Labels({ layer, shape, colours, forces }: Props) {
  const [troubles, setTroubles] = useState<readonly (LegTrouble | null)[]>([]);
  useEffect(
    () =>
      stage.watch(({ trouble }) =>
        setTroubles((before) => (textOf(before) === textOf(trouble) ? before : trouble)),
      ),
    [],
  );
  return (
    <div className="notes" ref={layer} aria-hidden="true">
      {shape.short.map((code, leg) => {
        const trouble = troubles[leg];
        return (
          <div key={code} className="note">
            {trouble ? (
              <span className="note-trouble">
                <b>⚠ {code}</b> {trouble.short}
              </span>
            ) : (
              <span className="note-leg">
                <i style={{ background: colours[leg] }} />
                {code}
              </span>
            )}
          </div>
        );
      })}
      <div className="note">
        <span className="note-margin" />
      </div>
      {forces &&
        shape.short.map((code) => (
          <div key={`force ${code}`} className="note">
            <span className="note-force" data-testid={`force-${code}`} />
          </div>
        ))}
    </div>
  );
}

function textOf(troubles: readonly (LegTrouble | null)[]): string {
  return troubles.map((trouble) => trouble?.short ?? "").join("|");
}
