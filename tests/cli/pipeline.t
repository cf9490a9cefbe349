# The method from end to end, small.

Simulate, train, evaluate, run, denoise, measure
  $ ptie simulate jet -o jet.h5 --size 64 --frames 4 --noise 2% --seed 3
  ! jet.h5: 4 frames of 64 x 64 px with the truth; rig in jet.ini
  $ cat jet.ini
  ; The rig of a simulated recording.
  [optics]
  wavelength = 532 nm
  pixel = 20 um
  defocus = 10 mm
  
  [planes]
  set = pair
  plus = /entry/data/plus
  minus = /entry/data/minus
  
  [recording]
  frame_rate = 25 kHz
  
  [flow]
  polarity = positive
  
  [solver]
  boundary = periodic
  $ ptie train -p $TESTS/small.ini -n 40 -e 2 --widths 4,8 -o m.safetensors --figure curves.png
  ! unet-4-8: 1,689 trainable parameters
  ! epoch 1/2 loss * PSNR * dB, validation loss * PSNR * dB (glob)
  ! epoch 2/2 loss * PSNR * dB, validation loss * PSNR * dB (glob)
  ! m.safetensors: best epoch 2 of 2: validation loss *, PSNR * dB, MAE * (glob)
  $ ptie info m.safetensors
  kind        model
  name        unet-4-8
  parameters  1,689 trainable
  levels      2 (4, 8 channels)
  inputs      1 channel
  output      sigmoid
  trained on  preset small, seed 1, 32 of 40 samples
  epochs      2
  seed        0
  generator   1
  kernels     * (glob)
  written by  0.1.0
  $ ptie evaluate m.safetensors -p $TESTS/small.ini -n 40 --data-seed 2 --figure examples.svg
  4 samples (test)
  
             PSNR (dB)      MAE     SSIM     loss
  noisy *.* 0.* 0.* 0.* (glob)
  denoised *.* 0.* 0.* 0.* (glob)
  $ ptie run --rig jet.ini jet.h5 -m m.safetensors -o phase.h5 --truth jet.h5:/entry/truth/phase \
  >   --figure frame.png --metrics frames.csv
  4 frames of 64 x 64 px, 20 um each, in * s (* frames/s) (glob)
  
  *TIE phase *denoised *truth (glob)
  MGM (rad/px) * ± * ± * ± * (glob)
  SBR * ± * ± * ± * (glob)
  BNS (rad) * ± * ± * ± * (glob)
  CNR * ± * ± * ± * (glob)
  RMSE (rad) * ± * ± * - (glob)
  correlation * ± * ± * - (glob)
  signal kept * ± * ± * - (glob)
  residual * ± * ± * ± * (glob)
  $ ptie info phase.h5
  kind         recording
  format       HDF5
  data set     /entry/data/denoised
  frames       4
  width        64 px
  height       64 px
  sample       f32
  unit         rad
  pixel        20 um
  frame rate   25 kHz
  duration     160 us
  first frame  * .. *, mean * (glob)
  $ wc -l < frames.csv
  5
  $ ptie metrics phase.h5 --truth jet.h5:/entry/truth/phase --figure metrics.png
  4 frames of 64 x 64 px; jet * px, background * px (glob)
  
  *TIE phase *denoised *truth (glob)
  MGM (rad/px) * ± * ± * ± * (glob)
  SBR * ± * ± * ± * (glob)
  BNS (rad) * ± * ± * ± * (glob)
  CNR * ± * ± * ± * (glob)
  RMSE (rad) * ± * ± * - (glob)
  correlation * ± * ± * - (glob)
  signal kept * ± * ± * - (glob)
  $ ptie denoise phase.h5:/entry/data/phase -m m.safetensors -o denoised.tif --polarity positive
  ! denoised.tif: denoised phase of phase.h5:/entry/data/phase
  $ ptie metrics phase.h5:/entry/data/phase denoised.tif
  4 frames of 64 x 64 px; jet * px, background * px (glob)
  
  *phase.h5:/entry/data/phase *denoised.tif (glob)
  MGM (rad/px) * ± * ± * (glob)
  SBR * ± * ± * (glob)
  BNS (rad) * ± * ± * (glob)
  CNR * ± * ± * (glob)
  $ ls
  curves.png
  denoised.tif
  examples.svg
  frame.png
  frames.csv
  jet.h5
  jet.ini
  m.safetensors
  m.safetensors.history.csv
  m.safetensors.history.json
  m.safetensors.last
  metrics.png
  phase.h5
  phase.html

What a camera would have recorded, with what belongs to it
  $ ptie simulate jet -o lab.mraw --camera $TESTS/../../examples/camera.ini --size 64 --frames 3 \
  >   --reference-frames 2 --dark-frames 2 --target-frames 2
  ! lab.mraw: 3 frames of 64 x 64 px with the truth; rig in lab.ini
  $ ls
  lab.cihx
  lab.ini
  lab.mraw
  lab_dark.cihx
  lab_dark.mraw
  lab_reference.cihx
  lab_reference.mraw
  lab_target.cihx
  lab_target.mraw
  lab_true.ini
  lab_truth.h5
  $ ptie info lab_truth.h5 | grep -E "frames|width|unit|pixel"
  frames       3
  width        32 px
  unit         rad
  pixel        40 um
  $ ptie reconstruct --rig lab_true.ini lab.mraw -o phase.h5 --truth lab_truth.h5 2> warnings | grep RMSE
  RMSE (rad) * (glob)
  $ printf '[light]\nbeem = 8 mm\n' > bad.ini
  $ ptie simulate jet -o other.mraw --camera bad.ini
  ! ptie: bad.ini:2: unknown key 'beem' in [light] (did you mean 'beam'?)
  [2]
  $ printf '[sensor]\nlayout = separate\n' > two.ini
  $ ptie simulate jet -o two.mraw --camera two.ini -f
  ! ptie: simulate: the rig two.ini would be written over the camera file
  [2]
  $ ptie simulate jet -o two.mraw --camera two.ini --rig-out rig.ini
  ! ptie: two.mraw: cannot write two planes to this kind of file (expected .h5 or .hdf5)
  [2]

The summary of a run and the metrics agree
  $ ptie simulate jet -o jet.h5 --size 64 --frames 3
  ! jet.h5: 3 frames of 64 x 64 px with the truth; rig in jet.ini
  $ ptie reconstruct --rig jet.ini jet.h5 -o phase.h5 --truth jet.h5:/entry/truth/phase --json > run.json
  $ ptie metrics phase.h5 --truth jet.h5:/entry/truth/phase --json > metrics.json
  $ python3 - <<'END'
  > import json
  > a, b = (json.load(open(name))["phase"] for name in ("run.json", "metrics.json"))
  > for key in a:
  >     for part in a[key] if b[key]["mean"] else []: # metrics has no planes
  >         assert abs(a[key][part] - b[key][part]) <= 1e-5 * abs(a[key][part]), (key, part)
  > print(*a)
  > END
  mgm sbr bns cnr rmse_rad correlation signal_kept residual

Frames of a subset are compared with the truth of the same frames
  $ ptie simulate jet -o jet.h5 --size 64 --frames 7 --fps 500
  ! jet.h5: 7 frames of 64 x 64 px with the truth; rig in jet.ini
  $ ptie reconstruct --rig jet.ini jet.h5 -o phase.h5 --frames 2::3 --json \
  >   --truth jet.h5:/entry/truth/phase > run.json
  $ ptie metrics phase.h5 --truth jet.h5:/entry/truth/phase --json > metrics.json
  $ python3 - <<'END'
  > import json
  > a, b = (json.load(open(name))["phase"]["rmse_rad"]["mean"] for name in ("run.json", "metrics.json"))
  > print(abs(a - b) <= 1e-5 * a)
  > END
  True
  $ ptie metrics phase.h5 --truth phase.h5:/entry/data/phase | tail -3 | head -2
  RMSE (rad) * 0.00 * - (glob)
  correlation * 1.00 * - (glob)
  $ ptie simulate jet -o short.h5 --size 64 --frames 5
  ! short.h5: 5 frames of 64 x 64 px with the truth; rig in short.ini
  $ ptie metrics phase.h5 --truth short.h5:/entry/truth/phase
  ! ptie: short.h5:/entry/truth/phase: has no truth for frame 5 of the recording (found 5 frames)
  [1]

A rig's data sets are those of HDF5 files; planes in other files are what they are
  $ ptie simulate jet -o jet.h5 --size 64 --frames 2
  ! jet.h5: 2 frames of 64 x 64 px with the truth; rig in jet.ini
  $ grep -v entry jet.ini > plain.ini
  $ $TESTS/npy plus.npy 2 64 64; $TESTS/npy minus.npy 2 64 64 other
  $ ptie reconstruct --rig plain.ini --plus plus.npy --minus minus.npy -o a.h5 2>/dev/null | tail -n +3 > a.txt
  $ ptie reconstruct --rig jet.ini --plus plus.npy --minus minus.npy -o b.h5 --figure b.png 2>/dev/null | tail -n +3 | diff a.txt -
  $ wc -l < a.txt
  6
  $ ptie reconstruct --rig jet.ini plus.npy -o c.h5
  ! ptie: run: plane 'minus' is missing (expected a recording of its own, since plus.npy has one plane)
  [2]

Training goes on with other kernels, and says so
  $ ptie train -p $TESTS/small.ini -n 10 -e 1 -b 4 -o m.safetensors --widths 2,2 --cpu scalar --steps 1
  ! unet-2-2: 261 trainable parameters
  ! m.safetensors: stopped before the first epoch ended; --resume goes on from m.safetensors.last
  $ env -u PTIE_CPU ptie train -p $TESTS/small.ini -n 10 -e 1 -b 4 -o m.safetensors --widths 2,2 --resume 2>&1 | grep -v epoch
  unet-2-2: 261 trainable parameters
  m.safetensors.last: begun with scalar kernels, goes on with *: the same but for rounding (glob)
  $ ptie info m.safetensors | grep kernels
  kernels     scalar, * (glob)

Threads do not change a byte
  $ ptie dataset -T 1 -p $TESTS/small.ini -n 9 -o d1.h5
  ! d1.h5: 9 pairs of preset */small.ini, seed 1 (glob)
  $ ptie dataset -T 2 -p $TESTS/small.ini -n 9 -o d2.h5
  ! d2.h5: 9 pairs of preset */small.ini, seed 1 (glob)
  $ cmp d1.h5 d2.h5

A training in two parts is the training in one
  $ ptie train -p $TESTS/small.ini -n 40 -e 3 --widths 2,2 -o one.safetensors -T 1
  ! unet-2-2: 261 trainable parameters
  ! epoch 1/3 loss * PSNR * dB, validation loss * PSNR * dB (glob)
  ! epoch 2/3 loss * PSNR * dB, validation loss * PSNR * dB (glob)
  ! epoch 3/3 loss * PSNR * dB, validation loss * PSNR * dB (glob)
  ! one.safetensors: best epoch 3 of 3: validation loss *, PSNR * dB, MAE * (glob)
  $ ptie train -p $TESTS/small.ini -n 40 -e 3 --widths 2,2 -o two.safetensors --steps 2
  ! unet-2-2: 261 trainable parameters
  ! epoch 1/3 loss * PSNR * dB, validation loss * PSNR * dB (glob)
  ! epoch 2/3 loss * PSNR * dB, validation loss * PSNR * dB (glob)
  ! two.safetensors: best epoch 2 of 2: validation loss *, PSNR * dB, MAE * (glob)
  $ ptie train -p $TESTS/small.ini -n 40 -e 3 --widths 2,2 -o two.safetensors --resume
  ! unet-2-2: 261 trainable parameters
  ! epoch 3/3 loss * PSNR * dB, validation loss * PSNR * dB (glob)
  ! two.safetensors: best epoch 3 of 3: validation loss *, PSNR * dB, MAE * (glob)
  $ cmp one.safetensors two.safetensors

A data set file and its preset give the same scores
  $ ptie train -p $TESTS/small.ini -n 20 -e 1 --widths 2,2 -o m.safetensors
  ! unet-2-2: 261 trainable parameters
  ! epoch 1/1 loss * PSNR * dB, validation loss * PSNR * dB (glob)
  ! m.safetensors: best epoch 1 of 1: validation loss *, PSNR * dB, MAE * (glob)
  $ ptie dataset -p $TESTS/small.ini -n 20 -o d.h5
  ! d.h5: 20 pairs of preset */small.ini, seed 1 (glob)
  $ cp d.h5 d.hdf5; ptie info d.hdf5 | head -1
  kind        data set
  $ ptie info d.h5
  kind        data set
  size        32 x 32 px
  samples     20
  train       16
  validation  2
  test        2
  $ ptie evaluate m.safetensors -d d.h5 --split all --json > file.json
  $ ptie evaluate m.safetensors -p $TESTS/small.ini -n 20 --split all --json > preset.json
  $ cmp file.json preset.json

A preset prints as a file that reads back
  $ ptie info paper > mine.ini
  $ ptie info paper --json | python3 -c 'import json, sys; d = json.load(sys.stdin); print(*d); print(d["text"], end="")' > json.ini
  $ head -1 json.ini; tail -n +2 json.ini | cmp - mine.ini
  kind text
  $ ptie info mine.ini > again.ini
  $ cmp mine.ini again.ini

Progress for programs is one JSON object per line
  $ ptie dataset -p $TESTS/small.ini -n 9 -o d.h5 --progress=json 2> lines
  $ python3 -c 'import json; print([json.loads(l)["done"] for l in open("lines") if l[0] == "{"][-1])'
  9

The gallery is a figure
  $ ptie simulate --gallery gallery.svg --size 32
  $ head -c 5 gallery.svg; tail -n 1 gallery.svg
  <?xml</svg>

The machine
  $ ptie info
  version         0.1.0
  commit          * (glob)
  compiler        * (glob)
  processor       * (glob)
  threads         * (glob)
  level           * (glob)
  levels          scalar* (glob)
  half precision  * (glob)
  kernels         conv3x3* (glob)
  presets         paper, realistic
  $ ptie info --json | python3 -c 'import json, sys; print(sorted(json.load(sys.stdin)))'
  ['commit', 'compiler', 'half_precision', 'kernels', 'level', 'levels', 'presets', 'processor', 'threads', 'version']
