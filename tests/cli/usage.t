# What a person types wrongly: one line, exit code 2, nothing written.

Without a command there is an overview
  $ ptie | head -3
  ptie 0.1.0: from parallel-TIE recordings to quantitative, denoised phase
  
    ptie run --rig lab.ini recording.h5 --model paper.safetensors -o phase.h5

The version is on stdout
  $ ptie --version
  ptie 0.1.0
  $ ptie -V
  ptie 0.1.0

An unknown command suggests the nearest
  $ ptie simulat
  ! ptie: unknown command 'simulat' (did you mean 'simulate'?)
  [2]
  $ ptie help evluate
  ! ptie: unknown command 'evluate' (did you mean 'evaluate'?)
  [2]

An unknown option suggests the nearest
  $ ptie simulate jet --fram 3
  ! ptie: simulate: unknown option '--fram' (did you mean '--frames'?)
  [2]
  $ ptie simulate jet -o jet.h5 -q
  ! ptie: simulate: unknown option '-q' (see 'ptie help simulate')
  [2]
  $ ptie --verbose
  ! ptie: unknown option '--verbose' (see 'ptie help')
  [2]
  $ ls

An option without its value
  $ ptie simulate jet -o
  ! ptie: simulate: option '-o' needs a value (FILE)
  [2]
  $ ptie train --epochs
  ! ptie: train: option '--epochs' needs a value (N)
  [2]
  $ ptie run --json=yes
  ! ptie: run: option '--json' takes no value
  [2]

A value of the wrong kind
  $ ptie simulate jet -o jet.h5 --frames many
  ! ptie: simulate: --frames: expected a whole number from 1 to 100000000, found 'many'
  [2]
  $ ptie simulate jet -o jet.h5 --frames 0
  ! ptie: simulate: --frames: expected a whole number from 1 to 100000000, found '0'
  [2]
  $ ptie simulate jet -o jet.h5 --frames 99999999999999999999
  ! ptie: simulate: --frames: expected a whole number from 1 to 100000000, found '99999999999999999999'
  [2]
  $ ptie simulate jet -o jet.h5 --wavelength 532
  ! ptie: simulate: --wavelength: expected a length such as 532 nm or 10 mm, found '532'
  [2]
  $ ptie simulate jet -o jet.h5 --noise lots
  ! ptie: simulate: --noise: expected a number, found 'lots'
  [2]
  $ ptie simulate jet -o jet.h5 --size 0x4
  ! ptie: flow.width_px is out of range (expected 16..32768, found 0)
  [2]
  $ ptie simulate jet -o jet.h5 --size 3by4
  ! ptie: simulate: --size: expected a size such as 256 or 320x240, found '3by4'
  [2]
  $ ptie simulate jet -o jet.h5 --family physics
  ! ptie: simulate: --family: unknown value 'physics' (did you mean 'physical'?)
  [2]
  $ ptie simulate jet -o jet.h5 --threads 1000
  ! ptie: simulate: --threads: expected a whole number from 0 to 256, found '1000'
  [2]
  $ ptie simulate jet -o jet.h5 --cpu avx3
  ! ptie: cpu: unknown level 'avx3' (expected auto, scalar, avx2 or avx512)
  [2]
  $ ptie metrics phase.h5 --jet 1,2,3
  ! ptie: metrics: --jet: expected a rectangle x,y,width,height in pixels, found '1,2,3'
  [2]
  $ ptie train --preset paper -o m.safetensors --widths 8
  ! ptie: train: --widths: expected 2 to 6 levels, found 1
  [2]
  $ ptie train --preset paper -o m.safetensors --widths 8,-16
  ! ptie: train: --widths: expected numbers such as 8,16,32, found '8,-16'
  [2]
  $ ls

Something is missing
  $ ptie simulate
  ! ptie: simulate: missing MORPHOLOGY (see 'ptie help simulate')
  [2]
  $ ptie simulate jet
  ! ptie: simulate: missing output (expected -o FILE.h5)
  [2]
  $ ptie dataset
  ! ptie: dataset: missing output (expected -o FILE.h5)
  [2]
  $ ptie train --preset paper
  ! ptie: train: missing output (expected -o FILE.safetensors)
  [2]
  $ ptie train -o m.safetensors
  ! ptie: train: expected --data FILE or --preset NAME
  [2]
  $ ptie evaluate
  ! ptie: evaluate: missing MODEL (see 'ptie help evaluate')
  [2]
  $ ptie evaluate m.safetensors
  ! ptie: evaluate: expected --data FILE or --preset NAME
  [2]
  $ ptie run
  ! ptie: run: missing RECORDING (see 'ptie help run')
  [2]
  $ ptie run jet.h5
  ! ptie: run: missing rig (expected --rig FILE.ini)
  [2]
  $ ptie run --rig jet.ini jet.h5
  ! ptie: run: missing model (expected --model FILE.safetensors)
  [2]
  $ ptie run --rig jet.ini jet.h5 --model m.safetensors
  ! ptie: run: missing output (expected -o FILE.h5)
  [2]
  $ ptie denoise phase.h5
  ! ptie: denoise: missing model (expected --model FILE.safetensors)
  [2]
  $ ptie metrics
  ! ptie: metrics: missing PHASE (see 'ptie help metrics')
  [2]

Something is too much
  $ ptie simulate jet shock -o jet.h5
  ! ptie: simulate: too many arguments (expected at most 1, found 'shock')
  [2]
  $ ptie simulate jet --gallery gallery.png
  ! ptie: simulate: --gallery draws every morphology (found 'jet')
  [2]
  $ ptie train --data d.h5 --preset paper -o m.safetensors
  ! ptie: train: expected --data FILE or --preset NAME, not both
  [2]
  $ ptie run jet.h5 --plus plus.tif --rig r.ini -m m.safetensors -o o.h5
  ! ptie: run: expected RECORDING or --plus, not both (found 'jet.h5')
  [2]
  $ ptie train --preset paper -o m.safetensors --from a.safetensors --widths 8,16,32
  ! ptie: train: --widths does not go with --from, whose model has its own
  [2]
  $ ptie train --preset paper -o m.safetensors --from a.safetensors --dropout 0.2
  ! ptie: train: --dropout does not go with --from, whose model has its own
  [2]
  $ ptie metrics phase.h5 --jet 0,0,9,9
  ! ptie: metrics: --jet and --background belong together
  [2]

Unknown names suggest the nearest
  $ ptie simulate jett -o jet.h5
  ! ptie: unknown morphology 'jett' (did you mean 'jet'?)
  [2]
  $ ptie dataset --preset papr -o d.h5
  ! ptie: papr: unknown preset (did you mean 'paper'? a file ends in .ini)
  [2]
  $ ptie train --preset papre -o m.safetensors
  ! ptie: papre: unknown preset (did you mean 'paper'? a file ends in .ini)
  [2]
  $ ls

Options may be written in every usual way
  $ ptie simulate -fT1 -ojet.h5 --frames=2 --size 16 -- jet
  ! jet.h5: 2 frames of 16 x 16 px with the truth; rig in jet.ini
  $ ptie info jet.h5 | head -4
  kind         recording
  format       HDF5
  data set     /entry/data/plus
  frames       2
