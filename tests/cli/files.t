# Outputs: never overwritten without -f, whole or not at all.

An existing output stays
  $ echo mine > jet.h5
  $ ptie simulate jet -o jet.h5 --size 16 --frames 1
  ! ptie: jet.h5: exists already (use -f to overwrite)
  [1]
  $ cat jet.h5
  mine
  $ ptie simulate jet -o jet.h5 --size 16 --frames 1 -f
  ! jet.h5: 1 frame of 16 x 16 px with the truth; rig in jet.ini
  $ ptie info jet.h5 | head -1
  kind         recording

An existing rig stops the simulation before it begins
  $ echo mine > jet.ini
  $ ptie simulate jet -o jet.h5 --size 16
  ! ptie: jet.ini: exists already (use -f to overwrite)
  [1]
  $ ls
  jet.ini

An existing figure stops the work before it begins
  $ touch curves.png
  $ ptie train --preset paper -o m.safetensors --figure curves.png
  ! ptie: curves.png: exists already (use -f to overwrite)
  [1]
  $ ptie simulate --gallery curves.png
  ! ptie: curves.png: exists already (use -f to overwrite)
  [1]
  $ ls
  curves.png

What another program is writing is left to it
  $ python3 - <<'END'
  > import fcntl, subprocess
  > with open("jet.h5.part", "wb") as part:
  >     part.write(b"half")
  >     fcntl.lockf(part, fcntl.LOCK_EX)
  >     subprocess.run("ptie simulate jet -o jet.h5 --size 32 --frames 2", shell=True)
  > print(open("jet.h5.part").read())
  > END
  half
  ! ptie: jet.h5: is being written by someone else (expected jet.h5.part to be free)
  $ ptie simulate jet -o jet.h5 --size 32 --frames 2
  ! jet.h5: 2 frames of 32 x 32 px with the truth; rig in jet.ini
  $ ls
  jet.h5
  jet.ini

So does a figure without a folder, or of a frame that will not be there
  $ ptie train --preset paper -o m.safetensors --figure nowhere/curves.png
  ! ptie: nowhere/curves.png: cannot create: No such file or directory
  [1]
  $ ptie simulate jet -o jet.h5 --size 32 --frames 5
  ! jet.h5: 5 frames of 32 x 32 px with the truth; rig in jet.ini
  $ ptie reconstruct --rig jet.ini jet.h5 -o phase.h5 --figure frame.png --figure-frame 2 --frames ::3
  ! ptie: --figure-frame: expected 0..1 of the frames processed, or -1, found 2
  [2]
  $ ptie reconstruct --rig jet.ini jet.h5 -o phase.h5 --figure frame.png --figure-frame 1 --frames ::3 | head -1
  2 frames of 32 x 32 px, 20 um each, in * s (* frames/s) (glob)
  $ ls
  frame.png
  jet.h5
  jet.ini
  phase.h5

A figure needs an ending that is known
  $ ptie simulate --gallery gallery.pdf
  ! ptie: gallery.pdf: not a kind of figure (expected a name ending in .png or .svg)
  [2]
  $ ptie train --preset paper -o m.safetensors --figure curves
  ! ptie: curves: not a kind of figure (expected a name ending in .png or .svg)
  [2]
  $ ls

A recording needs an ending that is known
  $ ptie simulate jet -o jet.dat
  ! ptie: jet.dat: cannot write two planes to this kind of file (expected .h5 or .hdf5)
  [2]
  $ ptie reconstruct --rig r.ini jet.h5 -o phase.tif
  ! ptie: reconstruct: --output: expected a name ending in .h5 or .hdf5, found 'phase.tif'
  [2]
  $ ls

A folder is no output
  $ mkdir out.h5
  $ ptie simulate jet -o out.h5 --size 16 -f
  ! ptie: out.h5: cannot write (expected a file name, found a directory)
  [1]
  $ ptie dataset -o out.h5 -n 3 -f
  ! ptie: out.h5: cannot write (expected a file name, found a directory)
  [1]
  $ ls
  out.h5

A device is no output
  $ ptie dataset -o /dev/null -n 3 -f
  ! ptie: /dev/null: cannot write (expected a file name, found a device)
  [1]

A folder that is not there
  $ ptie simulate jet -o no/such/jet.h5
  ! ptie: no/such/jet.h5: cannot create: No such file or directory
  [1]
  $ ptie dataset -o no/such/d.h5 -n 3
  ! ptie: no/such/d.h5: cannot create: No such file or directory
  [1]
  $ ptie train -p $TESTS/small.ini -n 30 -o no/such/m.safetensors
  ! unet-8-16-32: 29,777 trainable parameters
  ! ptie: no/such/m.safetensors: cannot create: No such file or directory
  [1]

A full disk leaves no file
  $ (ulimit -f 64; ptie simulate jet -o jet.h5 --size 128)
  ! ptie: jet.h5: cannot write the file: File too large
  [1]
  $ (ulimit -f 64; ptie dataset -n 20 -o d.h5)
  ! ptie: d.h5: cannot write the file: File too large
  [1]
  $ (ulimit -f 8; ptie simulate --gallery g.png)
  ! ptie: g.png: cannot write: File too large
  [1]
  $ ls
