// The name of a scene in the address of the page, and the values that it gives to parameters.

/** The scene named by `?scene=` or `#scene=`, or null if the address names none. */
export function sceneInAddress(address: { search: string; hash: string }): string | null {
  const query = new URLSearchParams(address.search).get('scene');
  return query ?? new URLSearchParams(address.hash.replace(/^#/, '')).get('scene');
}

/** Values of parameters by name, as in `?set=L=2&set=m=0.5`; a value that is no number is NaN. */
export type Values = Record<string, number>;

/** The values that `?set=` or `#set=` gives to parameters. */
export function valuesInAddress(address: { search: string; hash: string }): Values {
  const texts = [address.search, address.hash.replace(/^#/, '')].flatMap((part) =>
    new URLSearchParams(part).getAll('set'),
  );
  const pairs = texts.map((text): [string, number] => {
    const [name, ...rest] = text.split('=');
    const value = rest.join('=').trim();
    return [name.trim(), value === '' ? Number.NaN : Number(value)];
  });
  return Object.fromEntries(pairs);
}

/** The address of a scene with the values that differ from its own; the path of the page where there are none. */
export function addressOf(path: string, scene: string | null, values: Values): string {
  const parts = scene === null ? [] : [`scene=${encodeURIComponent(scene)}`];
  for (const [name, value] of Object.entries(values)) parts.push(`set=${encodeURIComponent(name)}=${value}`);
  return parts.length === 0 ? path : `?${parts.join('&')}`;
}
