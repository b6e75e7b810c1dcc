import { change } from "../../state/session";
import { useStudio } from "../../state/store";

/** Refusals of walks that can be shown all the same, with their problems. */
const SHOWABLE = new Set(["stroke", "unreachable", "collision"]);

/** What helps where a walk is refused. */
export function WalkRemedies() {
  const longest = useStudio((studio) => studio.failures.walk?.longest_stroke_mm ?? null);
  const showable = useStudio(
    (studio) => studio.state?.walk.strict === true && SHOWABLE.has(studio.failures.walk?.kind ?? ""),
  );
  const fitting = longest === null ? null : Math.floor(longest * 10) / 10;
  return (
    <div className="row">
      {fitting !== null && (
        <button type="button" className="button small" onClick={() => change("walk", { stroke_mm: fitting })}>
          Use {fitting} mm
        </button>
      )}
      {showable && (
        <button type="button" className="button small" onClick={() => change("walk", { strict: false })}>
          Show it anyway
        </button>
      )}
    </div>
  );
}
