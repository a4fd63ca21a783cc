/**
 * Comes before the page and outlives its failure: says so where a browser is too old for it, or where it did not arrive in full. Written
 * for browsers of any age, so without anything that came after 2009, and with its words built in.
 */
type Said = Record<"too-old" | "not-loaded" | "reload", string>;
declare var WORDS: { en: Said; [language: string]: Said };

(function () {
  var root = document.documentElement;

  function show(id: "too-old" | "not-loaded"): void {
    var language = (navigator.language || "en").slice(0, 2).toLowerCase();
    var words = WORDS[language] || WORDS.en;
    var page = document.createElement("main");
    var text = document.createElement("div");
    text.setAttribute("role", "alert");
    text.appendChild(document.createElement("h1")).appendChild(document.createTextNode(words[id]));
    var again = document.createElement("a");
    again.href = location.href;
    again.className = "link";
    again.appendChild(document.createTextNode(words.reload));
    if (id === "not-loaded") text.appendChild(again);
    page.id = "boot";
    page.lang = WORDS[language] ? language : "en";
    page.dir = language === "ar" ? "rtl" : "ltr";
    page.appendChild(text);
    document.body.appendChild(page);
  }

  /** Says it unless the page is there already; `refused` keeps the page from starting. */
  function tell(id: "too-old" | "not-loaded", refused: boolean): void {
    if (root.getAttribute("data-started") !== null || root.getAttribute("data-refused") !== null) return;
    if (refused) root.setAttribute("data-refused", id);
    if (document.getElementById("boot")) return;
    if (document.body) show(id);
    else
      document.addEventListener("DOMContentLoaded", function () {
        if (root.getAttribute("data-started") === null) show(id);
      });
  }

  window.addEventListener(
    "error",
    function (event) {
      var element = event.target as HTMLElement | null;
      var name = element && element.tagName;
      // Without its style a trial would not stand as it should.
      if (name === "SCRIPT" || (name === "LINK" && (element as HTMLLinkElement).rel === "stylesheet")) tell("not-loaded", true);
      else if (String(event.filename).indexOf("/assets/") >= 0) tell("too-old", true);
    },
    true,
  );

  var script = document.createElement("script");
  if (!("noModule" in script) || typeof Object.hasOwn !== "function" || typeof AbortController !== "function") tell("too-old", true);
  setTimeout(function () {
    tell("not-loaded", false);
  }, 30000);
})();
