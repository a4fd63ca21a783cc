// The oldest browsers that the pages are made for: the bundles' target, what the tests hold them to, and what people with older ones are
// told. Safari 15.4 is the last that iPhones and Macs of 2015 get without a change of system, Firefox 102 the last for Windows 7 to 8.1's
// contemporaries on extended support, Chrome 100 the oldest that panels still see; all three are of spring and summer 2022.
export const oldest = { Safari: "15.4", Firefox: "102", Chrome: "100" };

/** For esbuild. */
export const target = ["es2022", ...Object.entries(oldest).map(([name, version]) => name.toLowerCase() + version)];

/** "Safari 15.4, Firefox 102, Chrome 100" */
export const named = Object.entries(oldest).map((browser) => browser.join(" ")).join(", ");
