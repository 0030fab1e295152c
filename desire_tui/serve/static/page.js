document.getElementById("again").addEventListener("click", () => window.location.reload());
// the terminal takes keys at once; its field is made when everything has been loaded
window.addEventListener("load", () => setTimeout(() => document.querySelector(".xterm-helper-textarea")?.focus()));
