import { retry } from "../state/session";
import { useStudio } from "../state/store";

/** State of a connection that is not open, and a button to reconnect. */
export function Banner() {
  const link = useStudio((studio) => studio.link);
  const known = useStudio((studio) => studio.robot !== null);
  if (link.kind === "open" || (link.kind === "connecting" && !known)) return null;
  return (
    <div className="banner" role="status" data-testid="banner">
      {link.kind === "refused" && <span>{link.text}</span>}
      {link.kind === "lost" && (
        <>
          <span>{link.text} Reconnecting; your settings are kept.</span>
          <button type="button" className="button small" onClick={retry}>
            Reconnect now
          </button>
        </>
      )}
      {link.kind === "asleep" && (
        <>
          <span>{link.text} Your settings are kept.</span>
          <button type="button" className="button small" onClick={retry}>
            Reconnect
          </button>
        </>
      )}
      {link.kind === "connecting" && <span>Connecting …</span>}
    </div>
  );
}
