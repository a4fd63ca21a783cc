/** Copying a text, over http and in old browsers too. */

/** Puts a text into the clipboard; false where the browser won't, and then the page's code is selected, to be copied by hand. */
export async function copied(text: string): Promise<boolean> {
  try {
    // Without https there is no `clipboard`.
    await navigator.clipboard.writeText(text);
    return true;
  } catch {
    return copiedBySelection();
  }
}

function copiedBySelection(): boolean {
  const code = document.querySelector(".code");
  if (code !== null) getSelection()?.selectAllChildren(code);
  try {
    return code !== null && document.execCommand("copy");
  } catch {
    return false;
  }
}
