// Which scene the page opens: the address, the command that serves the page, or the default.

import { type Shipped, shippedScenes } from '../engine';

/** The first thing a visitor sees: alive at once, and asking to be pulled. */
export const DEFAULT_SCENE = 'strandbeest';

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

/** The scenes under their headings, both in the order in which they first come. */
export function grouped(scenes: readonly Shipped[]): { heading: string; scenes: Shipped[] }[] {
  const headings = new Map<string, Shipped[]>();
  for (const scene of scenes) headings.set(scene.group, [...(headings.get(scene.group) ?? []), scene]);
  return Array.from(headings, ([heading, members]) => ({ heading, scenes: members }));
}

/** The header in which `qhat play` names the file that /scene holds, percent-encoded. */
export const FILE_NAME_HEADER = 'x-qhat-scene-name';

/** The scene `qhat play SCENE` was given; null where the page is served by something else. */
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
