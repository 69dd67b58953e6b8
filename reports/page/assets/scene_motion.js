"use strict";
// A scene as the closed form has it, in motion, with the driving torque where it was asked for.

(() => {
  const own = crankcheck.embedded("motion");
  const torque = own.torque && crankcheck.unpacked(own.torque)[0];
  const told = document.getElementById("motion-torque");

  const stage = crankcheck.stage("motion", {
    overlays: () => [],
    drawn: (mechanism, position) => {
      if (!torque) return;
      const here = mechanism.between(torque, position);
      told.textContent = Number.isFinite(here) ? `Driving torque here: ${Number(here.toPrecision(3))} N m.`
        : "The driving torque is not determined here.";
    },
  });
  stage.set(own.drawing);
  stage.draw();
  stage.start();
})();
