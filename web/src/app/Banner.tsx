import { retry } from "../state/session";
import { useStudio } from "../state/store";

/** Says that the connection is broken, and what becomes of it. */
export function Banner() {
  const link = useStudio((studio) => studio.link);
  const known = useStudio((studio) => studio.robot !== null);
  if (link.kind === "open" || (link.kind === "connecting" && !known)) return null;
  return (
    <div className="banner" role="status" data-testid="banner">
      {link.kind === "refused" && <span>{link.text}</span>}
      {link.kind === "lost" && (
        <>
          <span>{link.text} Trying again; what you have set is kept.</span>
          <button type="button" className="button small" onClick={retry}>
            Now
          </button>
        </>
      )}
      {link.kind === "asleep" && (
        <>
          <span>{link.text} What you have set is kept.</span>
          <button type="button" className="button small" onClick={retry}>
            Go on
          </button>
        </>
      )}
      {link.kind === "connecting" && <span>Connecting …</span>}
    </div>
  );
}
