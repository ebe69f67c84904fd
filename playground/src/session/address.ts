// The name of a scene in the address of the page.

/** The scene named by `?scene=` or `#scene=`, or null if the address names none. */
export function sceneInAddress(address: { search: string; hash: string }): string | null {
  const query = new URLSearchParams(address.search).get('scene');
  return query ?? new URLSearchParams(address.hash.replace(/^#/, '')).get('scene');
}
