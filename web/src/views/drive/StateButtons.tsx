import { canRequest, REQUESTS, type RequestedState, type RobotState } from "./robotState";

interface Props {
  requested: RequestedState | null;
  present: RobotState;
  onRequest: (state: RequestedState) => void;
}

/** Buttons to stand up, sit down and fold. */
export function StateButtons({ requested, present, onRequest }: Props) {
  return (
    <div className="row states" role="group" aria-label="Request a state">
      {REQUESTS.map(({ state, label, hint }) => (
        <button
          key={state}
          type="button"
          className="button"
          title={hint}
          disabled={!canRequest(state, requested, present)}
          data-testid={`request-${state}`}
          onClick={() => onRequest(state)}
        >
          {label}
        </button>
      ))}
    </div>
  );
}
