"use strict";
// A scene that is in free motion, in motion as it was integrated.

(() => {
  const own = crankcheck.embedded("motion");
  const stage = crankcheck.stage("motion", { overlays: () => [], lasts: () => own.lasts_ms });
  stage.set(own.drawing);
  stage.draw();
  stage.start();
})();
