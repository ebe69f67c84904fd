// The sources of scene texts: the shipped scenes of the engine, and the command that serves the page.

import { shippedScenes } from '../engine';

export interface SceneSource {
  /** the name in the address; null for a scene that came from the command */
  name: string | null;
  fileName: string;
  text: string;
}

export function shipped(name: string): SceneSource | null {
  const scene = shippedScenes().find((candidate) => candidate.name === name);
  return scene ? { name, fileName: `${name}.toml`, text: scene.text } : null;
}

/** The header in which `qhat play` names the file that /scene holds, percent-encoded. */
const FILE_NAME_HEADER = 'x-qhat-scene-name';

/** The scene of `qhat play SCENE`; null if another program serves the page. */
export async function sceneFromCommand(): Promise<SceneSource | null> {
  // The command serves on the loopback address only. A request to another server would only add a 404 to its log.
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
