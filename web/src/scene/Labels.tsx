import { useEffect, useState, type RefObject } from "react";

import type { LegTrouble, Shape } from "./frame";
import { stage } from "./stage";

interface Props {
  layer: RefObject<HTMLDivElement | null>;
  shape: Shape;
  colours: readonly string[];
  /** Whether to show the short names of the legs. */
  names: boolean;
}

/**
 * Labels over the 3D view: names of the legs, problems of legs, and the stability margin.
 *
 * Hidden from screen readers, as the panel has the same in sentences. `LabelPositions` moves the labels.
 */
export function Labels({ layer, shape, colours, names }: Props) {
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
          <div key={code} className="note" hidden={!names && !trouble}>
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
    </div>
  );
}

function textOf(troubles: readonly (LegTrouble | null)[]): string {
  return troubles.map((trouble) => trouble?.short ?? "").join("|");
}
