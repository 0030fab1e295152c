autocmd BufNewFile,BufRead *.src setfiletype desire
