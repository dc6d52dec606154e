"""Style sheet of the report, for screens and for printing."""

STYLE = """
body { margin: 0; background: #ffffff; color: #222222; font: 16px/1.5 Helvetica, Arial, sans-serif; }
main { max-width: 1060px; margin: 0 auto; padding: 24px 20px 60px; }
h1 { font-size: 28px; line-height: 1.2; margin: 8px 0 14px; }
h2 { font-size: 21px; margin: 44px 0 10px; border-top: 1px solid #dddddd; padding-top: 20px; }
p { max-width: 46em; margin: 8px 0; }
p.answer { font-size: 20px; line-height: 1.4; }
figure { margin: 0; }
figcaption { font-size: 14px; color: #444444; margin-top: 5px; }
img { width: 100%; height: auto; display: block; }
svg { width: 100%; height: auto; display: block; }
.pair { display: flex; gap: 14px; margin: 16px 0; }
.pair figure { flex: 1 1 0; }
.maps { display: flex; gap: 14px; margin: 18px 0; }
.maps figure { flex: 1 1 0; }
.maps img { image-rendering: pixelated; }
.plot { max-width: 860px; margin: 26px 0; }
table { border-collapse: collapse; font-size: 14px; margin: 14px 0; }
th, td { padding: 4px 10px; border-bottom: 1px solid #e4e4e4; text-align: left; vertical-align: top; }
th { font-weight: 600; }
.numbers td { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
.numbers td.words { text-align: left; white-space: normal; min-width: 22em; }
.numbers thead th { vertical-align: bottom; max-width: 9em; }
.numbers tbody th { white-space: nowrap; font-weight: 400; }
.wide { overflow-x: auto; }
@media (max-width: 700px) { .pair, .maps { display: block; } .pair figure, .maps figure { margin-bottom: 14px; } }
@media print { main { max-width: none; } figure { break-inside: avoid; } }
"""
