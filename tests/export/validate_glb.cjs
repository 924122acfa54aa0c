// node validate_glb.cjs FILE.glb [--all]: what Khronos's gltf-validator says of a file. Exit 1: errors or warnings, one a
// line; 77: there is no module gltf-validator (npm install gltf-validator, and NODE_PATH to where it is). What it does not
// know, or cannot see the use of (MOZ_lightmap and its TEXCOORD_1), it counts as information: left out here.
const fs = require('fs');

let validator;
try {
  validator = require('gltf-validator');
} catch {
  console.error('no module gltf-validator');
  process.exit(77);
}

const kWarning = 1;  // severities: 0 error, 1 warning, 2 information, 3 hint
validator
    .validateBytes(new Uint8Array(fs.readFileSync(process.argv[2])), {maxIssues: 0, ignoredIssues: ['UNUSED_OBJECT', 'UNSUPPORTED_EXTENSION']})
    .then((report) => {
      const bad = report.issues.messages.filter((m) => m.severity <= kWarning);
      for (const m of bad) console.log(`${m.code} ${m.pointer || m.offset || ''}: ${m.message}`);
      if (process.argv[3] === '--all') {
        const counts = {};
        for (const m of report.issues.messages) counts[m.code] = (counts[m.code] || 0) + 1;
        console.log(JSON.stringify(counts), JSON.stringify(report.info, (k, v) => k === 'resources' ? undefined : v));
      }
      process.exit(bad.length > 0 ? 1 : 0);
    })
    .catch((error) => {
      console.log(String(error));
      process.exit(1);
    });
