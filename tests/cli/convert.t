# ptie convert: a recording as another kind of file.

Any kind becomes any other, and values stay
  $ ptie simulate jet -o jet.h5 --size 24x16 --frames 6
  ! jet.h5: 6 frames of 24 x 16 px with the truth; rig in jet.ini
  $ ptie convert jet.h5 a.tif && ptie convert a.tif a.h5 --compress && ptie convert a.h5 a.npy
  ! a.tif: from jet.h5
  ! a.h5: from a.tif
  ! a.npy: from a.h5
  $ /usr/bin/python3 - <<'END'
  > import h5py, numpy as np, tifffile
  > plus, f = h5py.File("jet.h5")["entry/data/plus"][()], h5py.File("a.h5")
  > print([bool((x == plus).all()) for x in (tifffile.imread("a.tif"), f["entry/data/data"][()], np.load("a.npy"))])
  > print(f["entry/data/data"].compression, f["entry/data/data"].shuffle, f["entry/data/data"].chunks)
  > print(f["entry/process_1"].attrs["recording"], "|", f["entry/process_1"].attrs["command"])
  > END
  [True, True, True]
  gzip True (1, 16, 24)
  a.tif | ptie convert a.tif a.h5 --compress
  $ ptie info a.h5 | grep -E "unit|pixel|rate"
  unit         I/I0
  pixel        20 um
  frame rate   25 kHz

A part of it: every second frame, a rectangle; the frame rate follows
  $ ptie simulate jet -o jet.h5 --size 24x16 --frames 6
  ! jet.h5: 6 frames of 24 x 16 px with the truth; rig in jet.ini
  $ ptie convert jet.h5 part.h5 --frames 1:6:2 --roi 2,3,10,11 && ptie info part.h5 | grep -E "frames|width|height|rate"
  frames       3
  width        10 px
  height       11 px
  frame rate   12.5 kHz
  ! part.h5: from jet.h5
  $ /usr/bin/python3 - <<'END'
  > import h5py
  > plus, part = h5py.File("jet.h5")["entry/data/plus"], h5py.File("part.h5")["entry/data"]
  > print((part["plus"][()] == plus[1:6:2, 3:14, 2:12]).all(), part["time"].attrs["first_frame"])
  > print([float(round(1e6 * t)) for t in part["time"]])
  > END
  True 1
  [40.0, 120.0, 200.0]
  $ ptie convert jet.h5 one.npy --frames 5 && ptie convert jet.h5 two.npy --frames 4: && ptie info two.npy | grep frames
  frames       2
  ! one.npy: from jet.h5
  ! two.npy: from jet.h5

Integers stay integers
  $ /usr/bin/python3 -c "
  > import numpy as np
  > np.save('raw.npy', (np.arange(60).reshape(3, 4, 5) * 69).astype('u2'))"
  $ ptie convert raw.npy raw.tif && ptie convert raw.tif raw_%d.png && ptie convert raw_%d.png raw.h5 && ptie convert raw.h5 back.npy
  ! raw.tif: from raw.npy
  ! raw_%d.png: from raw.tif
  ! raw.h5: from raw_%d.png
  ! back.npy: from raw.h5
  $ /usr/bin/python3 -c "
  > import numpy as np
  > a, b = np.load('raw.npy'), np.load('back.npy')
  > print((a == b).all(), b.dtype)"
  True uint16

Images share a scale when asked
  $ ptie simulate jet -o jet.h5 --size 24x16 --frames 2
  ! jet.h5: 2 frames of 24 x 16 px with the truth; rig in jet.ini
  $ ptie convert jet.h5 flow_%02d.png --range 0.5:1.5
  ! flow_%02d.png: from jet.h5
  $ /usr/bin/python3 -c "
  > from PIL import Image
  > print([Image.open('flow_0%d.png' % i).text['ptie:offset'] for i in range(2)])"
  ['0.5', '0.5']

A film of all frames has one range; for MATLAB, frames are the third dimension
  $ /usr/bin/python3 -c "
  > import numpy as np
  > np.save('r.npy', np.arange(24, dtype='f4').reshape(3, 2, 4) - 8)"
  $ ptie convert r.npy grey.y4m --fps 10 && ptie convert r.npy red.y4m --colours diverging && ptie convert r.npy r.mat
  ! grey.y4m: from r.npy
  ! red.y4m: from r.npy
  ! r.mat: from r.npy
  $ /usr/bin/python3 - <<'END'
  > import numpy as np
  > grey, red = open("grey.y4m", "rb").read(), open("red.y4m", "rb").read()
  > print(grey[:grey.index(b"FRAME")], red[:red.index(b"FRAME")])
  > print(grey[-14:-8], list(grey[-8:]))
  > print("white is", [red[red.index(b"FRAME") + 36 + 8 * k] for k in range(3)])
  > END
  b'YUV4MPEG2 W4 H2 F10:1 Ip A1:1 Cmono XCOLORRANGE=FULL\n' b'YUV4MPEG2 W4 H2 F25:1 Ip A1:1 C444 XCOLORRANGE=LIMITED\n'
  b'FRAME\n' [177, 188, 200, 211, 222, 233, 244, 255]
  white is [234, 128, 128]
  $ printf x > old.y4m; ptie convert r.npy old.y4m
  ! ptie: old.y4m: exists already (use -f to overwrite)
  [1]

The metrics of a result go with it
  $ ptie simulate jet -o jet.h5 --size 32 --frames 4 && ptie reconstruct --rig jet.ini jet.h5 -o phase.h5 | head -1
  4 frames of 32 x 32 px, 20 um each, in * s (* frames/s) (glob)
  ! jet.h5: 4 frames of 32 x 32 px with the truth; rig in jet.ini
  $ ptie convert phase.h5:/entry/data/phase p.mat --frames 1::2 && ptie convert phase.h5 p.h5 --frames 1::2
  ! p.mat: from phase.h5:/entry/data/phase
  ! p.h5: from phase.h5
  $ /usr/bin/python3 - <<'END'
  > import h5py, numpy as np, scipy.io
  > want = h5py.File("phase.h5")["entry/metrics/phase/residual"][1::2]
  > m, f = scipy.io.loadmat("p.mat"), h5py.File("p.h5")
  > print((m["metrics_phase_residual"][:, 0] == want).all(), (f["entry/metrics/phase/residual"][()] == want).all())
  > print(m["phase"].shape)
  > END
  True True
  (32, 32, 2)

What cannot be taken is told
  $ /usr/bin/python3 -c "import numpy as np; np.save('r.npy', np.zeros((5, 4, 6), 'f4'))"
  $ ptie convert r.npy a.tif --frames 5:
  ! ptie: r.npy: first frame out of range (expected 0..4, found 5)
  [2]
  $ ptie convert r.npy a.tif --frames 1:7
  ! ptie: r.npy: end of the frames out of range (expected 2..5, found 7)
  [2]
  $ ptie convert r.npy a.tif --frames 3:2
  ! ptie: convert: --frames: expected frames a:b:step, b not included, such as 0:100:2, found '3:2'
  [2]
  $ ptie convert r.npy a.tif --roi 2,2,5,1
  ! ptie: r.npy: rectangle outside the frame (expected inside 6 x 4 px, found 2,2,5,1)
  [2]
  $ ptie convert r.npy a.tif --range 3:1
  ! ptie: convert: --range: expected values low:high, such as -0.5:2, found '3:1'
  [2]
  $ ptie convert r.npy a.bmp
  ! ptie: a.bmp: cannot write this kind of file (expected .npy .tif .tiff .h5 .hdf5 .png .mat .y4m .mp4 or .mraw)
  [1]
  $ ptie convert r.npy ./r.npy -f
  ! ptie: ./r.npy: would be written over r.npy (expected a name of its own)
  [2]
  $ echo mine > a.npy; ptie convert r.npy a.npy
  ! ptie: a.npy: exists already (use -f to overwrite)
  [1]
  $ ptie convert r.npy
  ! ptie: convert: missing INPUT or OUTPUT (see 'ptie help convert')
  [2]
  $ ls
  a.npy
  r.npy
