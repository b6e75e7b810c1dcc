import { Component, type ReactNode } from "react";

interface State {
  failed: string | null;
}

/** Keeps the page alive where the picture can't be drawn: a browser without WebGL still has all the numbers. */
export class PictureGuard extends Component<{ children: ReactNode }, State> {
  override state: State = { failed: canDraw() ? null : "WebGL is off" };

  static getDerivedStateFromError(error: unknown): State {
    return { failed: error instanceof Error ? error.message : String(error) };
  }

  override render() {
    const { failed } = this.state;
    if (failed === null) return this.props.children;
    return (
      <p className="no-picture" role="status" data-testid="no-picture">
        This browser can’t draw in 3D ({failed}). All numbers are in the panel.
      </p>
    );
  }
}

function canDraw(): boolean {
  const canvas = document.createElement("canvas");
  const context = canvas.getContext("webgl2");
  // Browsers give a page only so many contexts; this one is not needed any more.
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return context !== null;
}
