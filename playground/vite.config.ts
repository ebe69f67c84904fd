import { svelte } from '@sveltejs/vite-plugin-svelte';
import type { Connect, Plugin } from 'vite';
import { defineConfig } from 'vitest/config';

// The built page may run its own script and its own WebAssembly, and talk to nobody but the server it came from.
// Only the build carries it: the development server injects inline styles.
const CONTENT_SECURITY_POLICY = [
  "default-src 'none'",
  "script-src 'self' 'wasm-unsafe-eval'",
  "style-src 'self'",
  "img-src 'self'",
  "connect-src 'self'",
  "base-uri 'none'",
  "form-action 'none'",
].join('; ');

function contentSecurityPolicy(): Plugin {
  return {
    name: 'qhat-content-security-policy',
    apply: 'build',
    transformIndexHtml: () => [
      {
        tag: 'meta',
        attrs: { 'http-equiv': 'Content-Security-Policy', content: CONTENT_SECURITY_POLICY },
        injectTo: 'head-prepend',
      },
    ],
  };
}

// `qhat play` answers /scene with the scene it was given, or with 204 when it was given none;
// Vite's own servers have none to give, and must not answer with the page itself.
function noSceneFromTheCommand(): Plugin {
  const answer: Connect.NextHandleFunction = (request, response, next) => {
    if (request.url !== '/scene') return next();
    response.statusCode = 204;
    response.end();
  };
  return {
    name: 'qhat-no-scene-from-the-command',
    configureServer: (server) => void server.middlewares.use(answer),
    configurePreviewServer: (server) => void server.middlewares.use(answer),
  };
}

export default defineConfig({
  // relative, so that the page works from any folder of any server
  base: './',
  plugins: [svelte(), contentSecurityPolicy(), noSceneFromTheCommand()],
  build: {
    target: 'es2022',
    // data: addresses would need img-src data: in the policy
    assetsInlineLimit: 0,
    // every browser that can run the engine knows modulepreload itself
    modulePreload: { polyfill: false },
  },
  server: { host: '127.0.0.1' },
  test: {
    projects: [
      {
        extends: true,
        test: { name: 'unit', include: ['tests/unit/**/*.test.ts'], environment: 'node' },
      },
      {
        extends: true,
        test: {
          name: 'browser',
          include: ['tests/browser/**/*.test.ts'],
          environment: 'node',
          // one browser, one page after the other: two of them on two cores would only slow each other
          fileParallelism: false,
          // a slow machine is not a wrong page: the limit only ends a hang
          testTimeout: 120_000,
          hookTimeout: 120_000,
        },
      },
      {
        extends: true,
        test: {
          name: 'measure',
          include: ['tests/measure.ts'],
          environment: 'node',
          testTimeout: 600_000,
          hookTimeout: 120_000,
        },
      },
    ],
  },
});
