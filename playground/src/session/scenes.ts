// Where the text of a scene comes from: the engine's own scenes, or the command that serves the page.

import { type Shipped, shippedScenes } from '../engine';

export interface SceneSource {
  /** the name in the address; null for a scene that came from the command */
  name: string | null;
  fileName: string;
  text: string;
}

export function shipped(name: string): SceneSource | null {
  const scene = shippedScenes().find((candidate) => candidate.name === name);
  return scene ? fromShipped(scene) : null;
}

export function fromShipped({ name, text }: Shipped): SceneSource {
  return { name, fileName: `${name}.toml`, text };
}

/** The header in which `qhat play` names the file that /scene holds, percent-encoded. */
export const FILE_NAME_HEADER = 'x-qhat-scene-name';

/** The scene that `qhat play SCENE` was given; null where another program serves the page. */
export async function sceneFromCommand(): Promise<SceneSource | null> {
  // The command serves on the loopback address only; asking any other server would only put a 404 in its log.
  if (!['127.0.0.1', 'localhost', '[::1]'].includes(location.hostname)) return null;
  try {
    const response = await fetch(new URL('scene', document.baseURI), { cache: 'no-store' });
    if (response.status !== 200) return null;
    const fileName = decodeURIComponent(response.headers.get(FILE_NAME_HEADER) ?? 'scene.toml');
    return { name: null, fileName, text: await response.text() };
  } catch {
    return null;
  }
}
