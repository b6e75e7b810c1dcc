import { Component, type ReactNode } from "react";

interface State {
  failed: string | null;
}

/** Error boundary of the 3D view: without WebGL, the rest of the page still works. */
export class SceneErrorBoundary extends Component<{ children: ReactNode }, State> {
  override state: State = { failed: canDraw() ? null : "WebGL is off" };

  static getDerivedStateFromError(error: unknown): State {
    return { failed: error instanceof Error ? error.message : String(error) };
  }

  override render() {
    const { failed } = this.state;
    if (failed === null) return this.props.children;
    return (
      <p className="no-picture" role="status" data-testid="no-picture">
        The 3D view is not available in this browser ({failed}). The panel has all values.
      </p>
    );
  }
}

function canDraw(): boolean {
  const canvas = document.createElement("canvas");
  const context = canvas.getContext("webgl2");
  // The number of WebGL contexts of a page is limited: release this one.
  context?.getExtension("WEBGL_lose_context")?.loseContext();
  return context !== null;
}
