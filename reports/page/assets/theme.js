"use strict";
// Before anything is painted: the theme that was chosen last, if any.
try {
  const chosen = localStorage.getItem("crankcheck-theme");
  if (chosen === "light" || chosen === "dark") document.documentElement.dataset.theme = chosen;
} catch {
  // A browser that keeps nothing for local files: the system's theme stands.
}
