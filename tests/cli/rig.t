# Rig files: written, checked, calibrated; planes after a step.

A new rig loads, says what it is, and keeps what was written
  $ ptie rig new --layout mosaic --mosaic crysta --pixel 12.5um --magnification 0.5 -o lab.ini
  ! lab.ini: written; 'ptie rig check lab.ini RECORDING' compares it with a recording
  $ grep -E '^(pixel|layout|mosaic|plus|minus) ' lab.ini
  pixel = 12.5um                   ; pitch of the sensor; of the object if magnification is 1
  layout = mosaic                  ; separate, mosaic, side-by-side, top-bottom, quadrants
  mosaic = crysta                  ; polarisers of a 2 x 2 cell: sony, crysta, or angles by rows
  plus = 0                         ; data set, or channels: 0, 0.98*0 + 0.02*45, left, top, tl
  minus = 90                       ; before focus
  $ ptie info lab.ini | grep pixel
  pixel       25 um
  $ ptie rig new -o lab.ini
  ! ptie: lab.ini: exists already (use -f to overwrite)
  [1]

Bad options are refused, and nothing is written
  $ ptie rig new --pixel 12.5 -o lab.ini
  ! ptie: lab.ini:6: pixel: expected a length such as 532 nm or 10 mm, found '12.5'
  [1]
  $ ptie rig new --set trple -o lab.ini
  ! ptie: rig: set: unknown value 'trple' (did you mean 'triple'?)
  [2]
  $ ptie rig new
  ! ptie: rig new: missing output (expected -o FILE.ini)
  [2]
  $ ptie rig nwe
  ! ptie: rig: unknown command 'nwe' (did you mean 'new'?)
  [2]
  $ ls

A camera's recording is calibrated and checked
  $ printf '[sensor]\nlayout = mosaic\n[mosaic]\nangles = crysta\n[minus]\nshift_x = 2\n' > camera.ini
  $ ptie simulate jet -o cam.mraw --camera camera.ini --size 256 --frames 2 --target-frames 4 --propagation angular-spectrum
  ! cam.mraw: 2 frames of 256 x 256 px with the truth; rig in cam.ini
  $ ptie rig check cam.ini cam.mraw --target cam_target.mraw | cut -c 1-22 | sed 's/ *$//'
  ok    size
  ok    saturation
  ok    exposure
  ok    mosaic
  ok    means of planes
  ok    flat field
  warn  registration
  warn  linear TIE
  ok    noise
  $ ptie rig calibrate cam.ini --target cam_target.mraw
                 minus
  gain * +- * (glob)
  shift_x * +- * px (glob)
  shift_y * +- * px (glob)
  magnification * +- * (glob)
  rotation * +- * mrad (glob)
  correlation * (glob)
  
  ! cam.ini: written
  $ python3 -c 'print(abs(float([l.split()[2] for l in open("cam.ini") if l.startswith("shift_x")][0]) - 1) < 0.1)'
  True
  $ head -1 cam.ini; ptie rig check cam.ini cam.mraw --target cam_target.mraw | grep -c '^ok'
  ; The rig of a simulated recording, before any calibration.
  8
  $ sed 's/^saturation.*/saturation = 100/' cam.ini > bad.ini
  $ ptie rig check bad.ini cam.mraw --json > report.json
  [1]
  $ python3 -c 'import json; print(json.load(open("report.json"))["saturation"]["verdict"])'
  FAIL

Planes after a step are a recording
  $ ptie simulate jet -o jet.h5 --size 64 --frames 6
  ! jet.h5: 6 frames of 64 x 64 px with the truth; rig in jet.ini
  $ ptie prepare --rig jet.ini jet.h5 --frames 1:6:2 --until gain -o planes.h5
  ! planes.h5: planes after step 'gain'
  $ ptie info planes.h5:/entry/data/minus | grep -E 'frames|width|rate'
  frames       3
  width        64 px
  frame rate   12.5 kHz
  $ ptie prepare --rig jet.ini jet.h5 --until gian -o planes.h5
  ! ptie: prepare: --until: unknown value 'gian' (did you mean 'gain'?)
  [2]
  $ ptie prepare --rig jet.ini jet.h5 -f -o jet.h5
  ! ptie: jet.h5: would be written over jet.h5 * (glob)
  [2]
