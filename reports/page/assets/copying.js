"use strict";
// Buttons that copy the text beside them, or select it where the browser does not let them.

for (const button of document.querySelectorAll("button.copy")) {
  const drawer = document.getElementById(button.dataset.copies) ?? button.parentElement;
  const text = drawer.querySelector("pre");
  button.hidden = false;
  button.addEventListener("click", async () => {
    try {
      await navigator.clipboard.writeText(text.textContent);
      button.textContent = "Copied";
    } catch {
      drawer.open = true; // what is closed can not be selected
      getSelection().selectAllChildren(text);
      button.textContent = "Selected";
    }
    setTimeout(() => {
      button.textContent = "Copy";
    }, 1500);
  });
}
