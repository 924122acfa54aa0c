// One html file: the viewer with its style, and a place where `deltalux export` puts the solution.
import { readFileSync } from 'node:fs';
import { defineConfig } from 'vite';
import { viteSingleFile } from 'vite-plugin-singlefile';

const three = readFileSync(new URL('node_modules/three/LICENSE', import.meta.url), 'utf8').trim();
const head = `<!--
This page was written by deltalux (Apache-2.0). It bundles three.js:

${three}
-->
`;

export default defineConfig({
  base: './',
  build: { target: 'es2022', assetsInlineLimit: 1 << 26, cssCodeSplit: false, modulePreload: false },
  plugins: [
    viteSingleFile({ removeViteModuleLoader: true }),
    {
      name: 'licences',
      enforce: 'post',
      generateBundle(_, bundle) {
        for (const part of Object.values(bundle))
          if (part.fileName.endsWith('.html'))
            part.source = part.source.toString().replace(/^<!doctype html>\n?/i, '<!doctype html>\n' + head);
      },
    },
  ],
});
