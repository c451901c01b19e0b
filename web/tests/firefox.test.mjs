// The viewer in Firefox.

import { testEngine } from "./engine-page.mjs";
import { firefox } from "./engines.mjs";

testEngine(firefox);
