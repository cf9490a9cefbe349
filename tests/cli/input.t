# Inputs that do not fit: one line that says what, where, expected, found.

A file that is not there
  $ ptie info nothere
  ! ptie: nothere: cannot read: No such file or directory
  [1]
  $ ptie info nothere.safetensors
  ! ptie: nothere.safetensors: cannot read: No such file or directory
  [1]
  $ ptie info nothere.ini
  ! ptie: nothere.ini: cannot open: No such file or directory
  [1]
  $ ptie evaluate nothere.safetensors --preset paper
  ! ptie: nothere.safetensors: cannot read: No such file or directory
  [1]
  $ ptie train --data nothere.h5 -o m.safetensors
  ! ptie: nothere.h5: cannot read: No such file or directory
  [1]
  $ ptie metrics nothere.h5
  ! ptie: nothere.h5: cannot read: No such file or directory
  [1]

A file of another kind
  $ echo 'not a recording' > text.tif
  $ ptie info text.tif
  ! ptie: text.tif: unknown kind of file (expected MRAW, CINE, NPY, PNG, TIFF, HDF5, MAT or raw)
  [1]
  $ ptie info $TESTS/run
  ! ptie: */tests/cli/run: unknown kind of file (expected MRAW, CINE, NPY, PNG, TIFF, HDF5, MAT or raw) (glob)
  [1]
  $ cp text.tif m.safetensors; ptie info m.safetensors
  ! ptie: m.safetensors: not a safetensors file, or cut (expected a header within 16 bytes, found 7309940746704154478)
  [1]

A folder without frames
  $ mkdir empty
  $ ptie info empty
  ! ptie: empty: no frames (expected numbered images: .png .tif .tiff .npy)
  [1]

A truncated recording
  $ ptie simulate jet -o jet.h5 --size 32 --frames 2
  ! jet.h5: 2 frames of 32 x 32 px with the truth; rig in jet.ini
  $ head -c 5000 jet.h5 > short.h5; ptie info short.h5
  ! ptie: short.h5: cannot open as HDF5: truncated file: * (glob)
  [1]
  $ $TESTS/npy r.npy 2 8 8; head -c 300 r.npy > short.npy; ptie info short.npy
  ! ptie: short.npy: file is cut short (expected 2 frames of 256 bytes, found 0)
  [1]

A rig with an unknown key or section
  $ ptie simulate jet -o jet.h5 --size 32 --frames 2
  ! jet.h5: 2 frames of 32 x 32 px with the truth; rig in jet.ini
  $ sed s/wavelength/wavelenght/ jet.ini > bad.ini
  $ ptie reconstruct --rig bad.ini jet.h5 -o phase.h5
  ! ptie: bad.ini:3: unknown key 'wavelenght' in [optics] (did you mean 'wavelength'?)
  [2]
  $ sed 's/\[optics\]/[optic]/' jet.ini > bad.ini
  $ ptie reconstruct --rig bad.ini jet.h5 -o phase.h5
  ! ptie: bad.ini:3: unknown section [optic] (did you mean [optics]?)
  [2]
  $ ls
  bad.ini
  jet.h5
  jet.ini

A rig without wavelength, or with one without unit
  $ ptie simulate jet -o jet.h5 --size 32 --frames 2
  ! jet.h5: 2 frames of 32 x 32 px with the truth; rig in jet.ini
  $ sed /wavelength/d jet.ini > bad.ini
  $ ptie reconstruct --rig bad.ini jet.h5 -o phase.h5
  ! ptie: bad.ini: missing key 'wavelength' in [optics] (expected a length such as 532 nm or 10 mm)
  [2]
  $ sed 's/532 nm/532/' jet.ini > bad.ini
  $ ptie reconstruct --rig bad.ini jet.h5 -o phase.h5
  ! ptie: bad.ini:3: wavelength: expected a length such as 532 nm or 10 mm, found '532'
  [1]
  $ sed 's/^plus.*/plus = nowhere/' jet.ini > bad.ini
  $ ptie reconstruct --rig bad.ini jet.h5 -o phase.h5
  ! ptie: bad.ini: [planes] plus: expected a data set such as /entry/data/plus, found 'nowhere'
  [1]
  $ sed 's/data.plus/data\/nowhere/' jet.ini > bad.ini
  $ ptie reconstruct --rig bad.ini jet.h5 -o phase.h5
  ! ptie: jet.h5: cannot open data set /entry/data/nowhere: object 'nowhere' doesn't exist
  [1]
  $ ls
  bad.ini
  jet.h5
  jet.ini

A preset with an unknown key
  $ printf '[camera]\nnoize = 3 %%\n' > bad.ini
  $ ptie dataset --preset bad.ini -n 3 -o d.h5
  ! ptie: bad.ini:2: unknown key 'noize' in [camera] (did you mean 'noise'?)
  [2]
  $ ls
  bad.ini

An incomplete rig is no preset
  $ printf '[optics]\nwavelength = 532 nm\n' > bad.ini
  $ ptie info bad.ini
  ! ptie: bad.ini: missing key 'pixel' in [optics] (expected a length such as 532 nm or 10 mm)
  [2]

Planes that the layout does not use
  $ $TESTS/npy a.npy 2 32 32
  $ printf '[optics]\nwavelength = 532 nm\npixel = 20 um\ndefocus = 10 mm\n' > rig.ini
  $ ptie reconstruct --rig rig.ini --plus a.npy --zero a.npy --minus a.npy -o phase.h5
  ! ptie: run: plane 'zero' has no place in the rig's set of planes
  [2]
  $ printf '[planes]\nset = reference\n' >> rig.ini
  $ ptie reconstruct --rig rig.ini --plus a.npy --minus a.npy --reference a.npy -o phase.h5
  ! ptie: run: plane 'minus' has no place in the rig's set of planes
  [2]

Planes of different sizes or lengths
  $ $TESTS/npy a.npy 2 32 32; $TESTS/npy b.npy 2 32 30; $TESTS/npy c.npy 1 32 32
  $ printf '[optics]\nwavelength = 532 nm\npixel = 20 um\ndefocus = 10 mm\n' > rig.ini
  $ ptie reconstruct --rig rig.ini --plus a.npy --minus b.npy -o phase.h5
  ! ptie: b.npy: frame size differs from a.npy (expected 32 x 32 px, found 30 x 32)
  [1]
  $ ptie reconstruct --rig rig.ini --plus a.npy --minus c.npy -o phase.h5
  ! ptie: c.npy: number of frames differs from a.npy (expected 2, found 1)
  [1]
  $ ptie reconstruct --rig rig.ini --plus a.npy -o phase.h5
  ! ptie: run: plane 'minus' is missing (expected a recording, or its data set in the rig's [planes])
  [2]
  $ ptie reconstruct --rig rig.ini --plus a.npy --minus a.npy --truth b.npy -o phase.h5
  ! ptie: b.npy: truth does not fit the phase (expected 32 x 32 px, found 30 x 32)
  [1]
  $ ls
  a.npy
  b.npy
  c.npy
  rig.ini

A frame that is not a number
  $ $TESTS/npy plus.npy 3 32 32 nan; $TESTS/npy minus.npy 3 32 32
  $ printf '[optics]\nwavelength = 532 nm\npixel = 20 um\ndefocus = 10 mm\n' > rig.ini
  $ ptie reconstruct --rig rig.ini --plus plus.npy --minus minus.npy -o phase.h5
  ! ptie: plus.npy: frame 2: value is not finite (at x=2, y=1; expected a number, found nan)
  [1]
  $ ls
  minus.npy
  plus.npy
  rig.ini

Planes without a flow
  $ $TESTS/npy same.npy 2 32 32
  $ printf '[optics]\nwavelength = 532 nm\npixel = 20 um\ndefocus = 10 mm\n' > rig.ini
  $ ptie reconstruct --rig rig.ini --plus same.npy --minus same.npy -o phase.h5
  2 frames of 32 x 32 px, 20 um each, in * s (* frames/s) (glob)
  
  ! phase.h5: no regions: no flow to tell from the background, so no MGM, SBR, BNS and CNR
  $ ls
  phase.h5
  rig.ini
  same.npy

Frames that are not there
  $ ptie simulate jet -o jet.h5 --size 32 --frames 3
  ! jet.h5: 3 frames of 32 x 32 px with the truth; rig in jet.ini
  $ ptie reconstruct --rig jet.ini jet.h5 -o phase.h5 --frames 3:
  ! ptie: jet.h5: first frame out of range (expected 0..2, found 3)
  [2]
  $ ptie reconstruct --rig jet.ini jet.h5 -o phase.h5 --frames :4
  ! ptie: jet.h5: end of the frames out of range (expected 1..3, found 4)
  [2]
  $ ls
  jet.h5
  jet.ini

A model that does not fit
  $ ptie train -p $TESTS/small.ini -n 10 -e 1 -o m.safetensors --widths 2,2
  ! unet-2-2: 261 trainable parameters
  ! epoch 1/1 * (glob)
  ! m.safetensors: best epoch 1 of 1: * (glob)
  $ python3 - <<'END'
  > data = open("m.safetensors", "rb").read()
  > open("other.safetensors", "wb").write(data.replace(b"unet-2-2", b"unet-2-4"))
  > open("short.safetensors", "wb").write(data[:-10])
  > END
  $ ptie info other.safetensors
  ! ptie: other.safetensors: tensor 'bottleneck.conv1.weight' does not fit unet-2-4 (expected [4, 2, 3, 3], found [2, 2, 3, 3])
  [1]
  $ ptie info short.safetensors
  ! ptie: short.safetensors: tensor 'out.weight': data outside the file
  [1]
  $ ptie simulate jet -o jet.h5 --size 32 --frames 2
  ! jet.h5: 2 frames of 32 x 32 px with the truth; rig in jet.ini
  $ ptie run --rig jet.ini jet.h5 -m other.safetensors -o phase.h5
  ! ptie: other.safetensors: tensor 'bottleneck.conv1.weight' does not fit unet-2-4 (expected [4, 2, 3, 3], found [2, 2, 3, 3])
  [1]
  $ ls *.h5
  jet.h5

Regions outside of the frame
  $ $TESTS/npy phase.npy 2 32 32
  $ ptie metrics phase.npy --jet 0,0,33,4 --background 0,10,4,4
  ! ptie: region 'jet' leaves the image or is empty (expected within 32 x 32 px, found 33 x 4 at x=0, y=0)
  [2]
  $ ptie metrics phase.npy --jet 0,0,0,4 --background 0,10,4,4
  ! ptie: metrics: --jet and --background belong together
  [2]

A map without a flow has no regions to propose
  $ $TESTS/npy flat.npy 2 8 8 flat; ptie metrics flat.npy
  ! ptie: flat.npy: mean map: is constant (expected a flow, found 1 everywhere)
  [1]
