// node validate.mjs scene.glb…: what the Khronos glTF validator says; exit code 1 for any error or warning.

import { readFile } from 'node:fs/promises';
import validator from 'gltf-validator';

const SEVERITIES = ['error', 'warning', 'information', 'hint'];
// Names of attributes that a ratified extension has and version 2.0.0-dev.3.10 does not know
const RATIFIED = /\/attributes\/KHR_gaussian_splatting:(ROTATION|SCALE|OPACITY|SH_DEGREE_[0-2]_COEF_[0-4])$/;
const files = process.argv.slice(2);
if (files.length === 0) {
  console.error('usage: node validate.mjs scene.glb…');
  process.exit(2);
}

let complaints = 0;
for (const file of files) {
  const bytes = new Uint8Array(await readFile(file));
  const { issues, info } = await validator.validateBytes(bytes, {
    uri: file,
    format: 'glb',
    maxIssues: 1000,
    severityOverrides: { GLB_UNKNOWN_CHUNK_TYPE: 2 }, // the groups of a clip; glTF tells readers to ignore such chunks
  });
  const known = issues.messages.filter(
    ({ code, pointer }) => code === 'MESH_PRIMITIVE_INVALID_ATTRIBUTE' && RATIFIED.test(pointer),
  );
  complaints += issues.numErrors + issues.numWarnings - known.length;
  const counts = `${issues.numErrors - known.length} errors, ${issues.numWarnings} warnings, ${issues.numInfos} informations, ${issues.numHints} hints`;
  console.log(`${file}: ${counts} (${info?.extensionsUsed?.join(', ') ?? 'not read'})`);
  for (const { severity, code, pointer, message } of issues.messages.filter((issue) => !known.includes(issue))) {
    console.log(`  ${SEVERITIES[severity]} ${code} ${pointer ?? ''} ${message}`);
  }
}
process.exit(complaints === 0 ? 0 : 1);
