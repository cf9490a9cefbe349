# What `ptie info` says of the files of cameras.

A Photron recording, by any of its files
  $ ptie info $TESTS/../golden/cameras/xml.mraw
  kind         recording
  format       MRAW
  frames       3
  width        7 px
  height       5 px
  corner       x=129, y=64 on the sensor
  sample       u12 packed
  bit depth    12
  black level  0
  white level  4095
  frame rate   20 Hz (one of 2500 at 50 kHz)
  duration     150 ms
  exposure     5 us
  camera       FASTCAM Test X
  date         2024/2/29 23:59
  trigger      mode 7
  comment      a < b & c
  first frame  0 .. 1242, mean 621
  $ ptie info $TESTS/../golden/cameras/xml.mraw > a; ptie info $TESTS/../golden/cameras/xml.cihx | diff a -

One that was cut short, and a header without frames
  $ ptie info $TESTS/../golden/cameras/short.mraw | grep -E "frames|warning"
  frames       3 of 9
  warning      file is cut short: 3 of 9 frames are there
  $ cp $TESTS/../golden/cameras/u12.cih . && ptie info u12.cih | tail -2
  comment      gr??e
  warning      this is the header alone: the frames (.mraw) are not beside it
  $ ptie convert u12.cih u12.npy
  ! ptie: u12.cih: the recording's other file is missing (expected the .mraw beside it)
  [1]

A Phantom recording, for a program
  $ ptie info $TESTS/../golden/cameras/plain8.cine --json
  {
    "kind": "recording",
    "format": "CINE",
    "frames": 3,
    "width": 7,
    "height": 5,
    "rows": "bottom row first in the file; read top row first",
    "sample": "u8",
    "bit_depth": 8,
    "pixel": 2e-05,
    "frame_rate": *, (glob)
    "duration": *, (glob)
    "exposure": 9.7e-06,
    "camera": "Phantom version 73, serial 4711",
    "date": "2023-11-14 22:13:20 UTC",
    "trigger": "at frame 2",
    "first_frame": "0 .. 46, mean 23"
  }

Codes of 10 bits, and the counts they stand for
  $ ptie info $TESTS/../golden/cameras/packed10.cine | grep -E "bit|level|first"
  bit depth    12
  black level  64
  white level  4064
  first frame  4 .. 422, mean 179.371
  $ ptie info $TESTS/../golden/cameras/packed10.cine:/codes | grep -E "bit|level|first"
  bit depth    10
  black level  64
  white level  1014
  first frame  0 .. 322, mean 161

They are converted like any other
  $ ptie convert $TESTS/../golden/cameras/padded.mraw padded.tif && ptie info padded.tif | grep -E "format|frames|sample|rate"
  format       TIFF
  frames       3
  sample       u16
  frame rate   1.6667 kHz
  ! padded.tif: from * (glob)

What is cut short is used, and the result says so
  $ ptie rig new --layout side-by-side -o split.ini && ptie reconstruct --rig split.ini $TESTS/../golden/cameras/short.mraw -o short.h5 | head -1
  3 frames of 3 x 5 px, 20 um each, in * (glob)
  ! split.ini: written; * (glob)
  ! short.h5: *: file is cut short: 3 of 9 frames are there (glob)
  ! short.h5: light unsteady: * (glob)
  ! short.h5: no regions: * (glob)

A recording is no phase
  $ ptie denoise $TESTS/../golden/cameras/padded.mraw -m $TESTS/../../models/paper.safetensors -o no.h5
  ! ptie: *: intensity of a camera (expected phase in rad, as 'ptie run' makes it, found 12 bits) (glob)
  [1]
