// The viewer in WebKit: WebKitGTK's MiniBrowser.

import { testEngine } from "./engine-page.mjs";
import { webkit } from "./engines.mjs";

testEngine(webkit);
