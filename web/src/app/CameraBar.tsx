import { CAMERAS, type CameraName } from "../scene/cameras";

interface Props {
  camera: CameraName;
  onChoose: (camera: CameraName) => void;
}

/** Choice of the camera. Pressing the active one resets its position. */
export function CameraBar({ camera, onChoose }: Props) {
  return (
    <div className="segments cameras" role="group" aria-label="Camera">
      {CAMERAS.map(({ name, label, hint }) => (
        <button
          key={name}
          type="button"
          className="segment"
          title={hint}
          aria-pressed={name === camera}
          data-testid={`camera-${name}`}
          onClick={() => onChoose(name)}
        >
          {label}
        </button>
      ))}
    </div>
  );
}
